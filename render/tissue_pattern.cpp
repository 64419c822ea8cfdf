#include "render/tissue_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/vec.h"

namespace trocar {

namespace {

using Cell = std::array<int, 3>;

std::uint32_t mix_bits(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x7FEB352Du;
  h ^= h >> 15;
  h *= 0x846CA68Bu;
  return h ^ (h >> 16);
}

// A random vector of [0, 1)^3 at each point of a lattice that repeats after `period` points.
struct Lattice {
  int period;
  std::vector<Vec3> value;

  Lattice(int n, std::uint32_t seed) : period(n) {
    std::uint32_t h = mix_bits(seed);
    const auto next = [&h] { return (h = mix_bits(h + 0x9E3779B9u)) / 4294967296.0; };
    for (int k = 0; k < n * n * n; ++k) {
      const double a = next(), b = next(), c = next();
      value.emplace_back(a, b, c);
    }
  }
  int wrap(int k) const { return ((k % period) + period) % period; }
  const Vec3& at(const Cell& c) const {
    return value[(wrap(c[2]) * period + wrap(c[1])) * period + wrap(c[0])];
  }
};

double fade(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}

// Periodic gradient noise (Perlin 2002), about -0.8 to 0.8.
double gradient_noise(const Lattice& lattice, const Vec3& p) {
  const Vec3 base = p.array().floor();
  const Vec3 f = p - base;
  const Vec3 weight(fade(f[0]), fade(f[1]), fade(f[2]));
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell bit = {corner & 1, corner >> 1 & 1, corner >> 2};
    double w = 1;
    Cell c;
    Vec3 d;
    for (int k = 0; k < 3; ++k) {
      c[k] = static_cast<int>(base[k]) + bit[k];
      d[k] = f[k] - bit[k];
      w *= bit[k] ? weight[k] : 1 - weight[k];
    }
    sum += w * (2 * lattice.at(c) - Vec3::Ones()).dot(d);
  }
  return 1.4 * sum;
}

// Second nearest less nearest distance to jittered cell centres (Worley 1996): 0 on the borders of
// the cells.
double cell_border_distance(const Lattice& lattice, const Vec3& p) {
  const Vec3 base = p.array().floor();
  double first = 1e9, second = 1e9;
  for (int k = 0; k < 27; ++k) {
    const Vec3 offset(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const Vec3 corner = base + offset;
    const Cell c = {static_cast<int>(corner[0]), static_cast<int>(corner[1]),
                    static_cast<int>(corner[2])};
    const double d = (p - corner - lattice.at(c)).squaredNorm();
    second = std::min(second, std::max(first, d));
    first = std::min(first, d);
  }
  return std::sqrt(second) - std::sqrt(first);
}

std::uint8_t to_byte(double v) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
}

// All noises of the pattern.
struct Noises {
  std::array<Lattice, 3> cloud;  // octaves
  std::array<Lattice, 3> warp;
  std::array<Lattice, 2> vessel;
  Lattice cell;

  explicit Noises(int n)
      : cloud{Lattice(n / 2, 1), Lattice(n, 2), Lattice(2 * n, 3)},
        warp{Lattice(n, 4), Lattice(n, 5), Lattice(n, 6)},
        vessel{Lattice(n / 2, 7), Lattice(n / 2, 8)},
        cell(n, 9) {}

  double cloudy(const Vec3& p) const {
    return gradient_noise(cloud[0], 0.5 * p) + 0.5 * gradient_noise(cloud[1], p) +
           0.25 * gradient_noise(cloud[2], 2 * p);
  }
  // Vessels wind: their field is looked up at a place that noise has moved.
  Vec3 vessel_place(const Vec3& p) const {
    return 0.5 * p + 0.35 * Vec3(gradient_noise(warp[0], p), gradient_noise(warp[1], p),
                                 gradient_noise(warp[2], p));
  }
};

// Central differences on the periodic grid.
std::vector<std::uint8_t> bump_texels(const std::vector<double>& height, int n) {
  std::vector<std::uint8_t> texel;
  texel.reserve(height.size() * 4);
  const auto at = [&](int i, int j, int k) {
    return height[((k + n) % n * n + (j + n) % n) * n + (i + n) % n];
  };
  const double scale = 0.02 * n;  // fills the bytes without clipping
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 slope(at(i + 1, j, k) - at(i - 1, j, k), at(i, j + 1, k) - at(i, j - 1, k),
                         at(i, j, k + 1) - at(i, j, k - 1));
        for (const double g : slope) texel.push_back(to_byte(0.5 + scale * g));
        texel.push_back(to_byte(0.5 + 0.5 * at(i, j, k)));
      }
  return texel;
}

}  // namespace

TissuePattern make_tissue_pattern(int side, int n_cells) {
  const Noises noise(n_cells);
  TissuePattern pattern{.side = side};
  std::vector<double> height;
  for (int t = 0; t < side * side * side; ++t) {
    const Vec3 texel(t % side, t / side % side, t / side / side);
    const Vec3 p = (texel + Vec3::Constant(0.5)) * n_cells / side;
    const double cells = cell_border_distance(noise.cell, p);
    const double cloud = noise.cloudy(p);
    const Vec3 winding = noise.vessel_place(p);
    pattern.field.push_back(to_byte(0.5 + 0.5 * cloud));
    pattern.field.push_back(to_byte(cells));
    pattern.field.push_back(to_byte(0.5 + 0.6 * gradient_noise(noise.vessel[0], winding)));
    pattern.field.push_back(to_byte(0.5 + 0.6 * gradient_noise(noise.vessel[1], winding)));
    height.push_back(0.55 * cloud + 0.5 * std::min(cells, 0.5));
  }
  pattern.bump = bump_texels(height, side);
  return pattern;
}

}  // namespace trocar
