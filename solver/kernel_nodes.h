// The nodes' loops of a step, written once for any pack: forces out of sums, motion out of forces.
// All of a node's operations are the same wherever it stands in a loop, so that its bits don't
// depend on who its neighbours are.
#pragma once

#include <cstdint>
#include <utility>

#include "solver/corner_gather.h"
#include "solver/kernel_works.h"
#include "solver/node_by_node.h"

namespace trocar {

template <class Pack>
struct NodeLoops {
  static constexpr int width = pack_width<Pack>, eight = 8;

  // What is constant is copied: memory could change with every store.
  template <class Real>
  static void force(const NodeForces<Real>& given, const std::int32_t* node, std::int64_t n) {
    const NodeForces<Real> task = given;
    const Pack gravity[3] = {gravity_of<0>(task), gravity_of<1>(task), gravity_of<2>(task)};
    for_pieces(
        node, n, [&](std::int64_t i, auto is_eight) __attribute__((always_inline)) {
          find_force(task, gravity, i, is_eight, task.force + 3 * i);
        });
  }

  template <class Real>
  static void step(const NodeForces<Real>& given, const NodeMotion& given_motion,
                   const std::int32_t* node, std::int64_t n) {
    const NodeForces<Real> task = given;
    const NodeMotion motion = given_motion;
    const Pack gravity[3] = {gravity_of<0>(task), gravity_of<1>(task), gravity_of<2>(task)};
    const Factors by = factors_of(motion);
    for_pieces(
        node, n, [&](std::int64_t i, auto is_eight) __attribute__((always_inline)) {
          const bool waits_for_others = any_waits(motion.fixed + i, is_eight);
          if constexpr (is_eight && width > 1)
            if (task.sum_stride > 0 && !waits_for_others) {
              for (std::int64_t l = i; l < i + eight; l += width)
                move_components(task, by, nodes_from(motion, l, nullptr), l);
              return;
            }
          Forces force;
          find_force(task, gravity, i, is_eight, force.of);
          if (waits_for_others)
            return move_others(motion, force, i, is_eight ? eight : 1, task.force + 3 * i);
          const Nodes nodes = nodes_from(motion, i, force.of);
          if constexpr (is_eight)
            for (int l = 0; l < eight; l += width) move(by, behind(nodes, l));
          else
            move_one(motion, nodes);
        });
  }

  template <class Real>
  static void add_places(Real* sum, std::int64_t stride, std::int64_t place,
                         const std::int32_t* node, std::int64_t n) {
    if (stride > 0) return add_component_places(sum, stride, place, node, n);
    Real* from = sum + 4 * place;
    for (std::int64_t k = 0; k < n; ++k, from += 4) {
      Real* const to = sum + 4 * std::int64_t{node[k]};
      if constexpr (width >= 4) {
        using Quad = PackOf<Real, 4>;
        store(to, Quad(load<Quad>(to) + load<Quad>(from)));
        store(from, Quad{});
      } else {
        for (int j = 0; j < 4; ++j) to[j] += from[j];
        for (int j = 0; j < 4; ++j) from[j] = 0;
      }
    }
  }

  static void split(const double* from, std::int64_t n, double* to, std::int64_t stride) {
    std::int64_t i = 0;
    if constexpr (width >= 4)
      for (; i + width <= n; i += width) {
        Pack x[3];
        gather_row(from + 3 * i, x);
        for (int j = 0; j < 3; ++j) store(to + j * stride + i, x[j]);
      }
    for (; i < n; ++i)
      for (int j = 0; j < 3; ++j) to[j * stride + i] = from[3 * i + j];
  }

  static void motion(const NodeMotion& given, std::int64_t begin, std::int64_t end) {
    const NodeMotion task = given;
    const Factors by = factors_of(task);
    std::int64_t i = begin;
    for (; i + width <= end; i += width) move(by, nodes_from(task, i, task.force + 3 * i));
    for (; i < end; ++i) move_one(task, nodes_from(task, i, task.force + 3 * i));
  }

 private:
  struct Nodes {
    const double* inertia;
    const std::uint8_t* fixed;
    const double* force;
    double *v, *u;
  };

  // force: of the i-th node.
  static Nodes nodes_from(const NodeMotion& task, std::int64_t i, const double* force) {
    return {task.inertia + i, task.fixed + i, force, task.v + 3 * i, task.u + 3 * i};
  }
  static Nodes behind(const Nodes& nodes, std::int64_t i) {
    return {nodes.inertia + i, nodes.fixed + i, nodes.force + 3 * i, nodes.v + 3 * i,
            nodes.u + 3 * i};
  }

  struct Forces {
    alignas(64) double of[3 * eight];
  };
  // Of NodeMotion, in all lanes.
  struct Factors {
    Pack keep, gain, dt;
  };
  static Factors factors_of(const NodeMotion& task) {
    return {splat<Pack>(task.keep), splat<Pack>(task.gain), splat<Pack>(task.dt)};
  }

  // Calls body(first node, whether eight follow each other from there or it is alone), of ascending
  // nodes.
  template <class Body>
  [[gnu::always_inline]] static void for_pieces(const std::int32_t* node, std::int64_t n,
                                                const Body& body) {
    for (std::int64_t k = 0; k < n;)
      if (k + eight <= n && node[k + eight - 1] - node[k] == eight - 1) {
        body(node[k], std::true_type{});
        k += eight;
      } else {
        body(node[k++], std::false_type{});
      }
  }

  // Of the i-th node, or of eight.
  template <class Real, bool is_eight>
  [[gnu::always_inline]] static void find_force(const NodeForces<Real>& task,
                                                const Pack (&gravity)[3], std::int64_t i,
                                                std::bool_constant<is_eight>, double* force) {
    if (task.sum_stride > 0) {
      if constexpr (is_eight && width > 1)
        for (int l = 0; l < eight; l += width) force_of_components(task, i + l, force + 3 * l);
      else
        for (int l = 0; l < (is_eight ? eight : 1); ++l)
          force_of_component_sums(task, i + l, force + 3 * l);
    } else if constexpr (is_eight && width == eight) {
      force_of_eight(gravity, task.mass + i, task.sum + 4 * i, force);
    } else {
      for (int l = 0; l < (is_eight ? eight : 1); ++l)
        force_of_node(task, task.mass[i + l], task.sum + 4 * (i + l), force + 3 * l);
    }
  }

  // m g - s and a b + c, rounded once where the instruction set can. A compiler that is left to it
  // may round one of two loops twice, as it does when sanitizers look on.
  template <class P>
  [[gnu::always_inline]] static P weight_less_sum(const P& m, const P& g, const P& s) {
    if constexpr (width < 4)
      return m * g - s;
    else if constexpr (std::is_same_v<P, double>)
      return __builtin_fma(m, g, -s);
    else if constexpr (pack_width<P> == 8)
      return _mm512_fmsub_pd(m, g, s);
    else
      return _mm256_fmsub_pd(m, g, s);
  }
  template <class P>
  [[gnu::always_inline]] static P product_plus(const P& a, const P& b, const P& c) {
    if constexpr (width < 4)
      return a * b + c;
    else if constexpr (std::is_same_v<P, double>)
      return __builtin_fma(a, b, c);
    else if constexpr (width == 8)
      return _mm512_fmadd_pd(a, b, c);
    else
      return _mm256_fmadd_pd(a, b, c);
  }

  template <class Real>
  [[gnu::always_inline]] static void force_of_node(const NodeForces<Real>& task, double mass,
                                                   Real* sum, double* force) {
    if constexpr (width >= 4) {
      using Quad = PackOf<double, 4>;
      const Quad f = weight_less_sum(Quad{mass, mass, mass, mass}, load<Quad>(task.gravity),
                                     load_in_double<Quad>(sum));
      // In two parts: a masked store takes ten cycles.
      store(force, __builtin_shufflevector(f, f, 0, 1));
      force[2] = f[2];
      store(sum, PackOf<Real, 4>{});
    } else {
      for (int j = 0; j < 3; ++j) force[j] = mass * task.gravity[j] - sum[j];
      for (int j = 0; j < 4; ++j) sum[j] = 0;
    }
  }

  // Component by component, rounded alike.
  template <class Real>
  [[gnu::always_inline]] static void force_of_component_sums(const NodeForces<Real>& task,
                                                             std::int64_t i, double* force) {
    for (int j = 0; j < 3; ++j) {
      Real& sum = task.sum[j * task.sum_stride + i];
      force[j] = weight_less_sum(task.mass[i], task.gravity[j], double{sum});
      sum = 0;
    }
  }

  // Of nodes that follow each other, component by component.
  template <class Real>
  [[gnu::always_inline]] static void take_components(const NodeForces<Real>& task, std::int64_t i,
                                                     Pack (&f)[3]) {
    const Pack mass = load<Pack>(task.mass + i);
    for (int j = 0; j < 3; ++j) {
      Real* const sum = task.sum + j * task.sum_stride + i;
      f[j] = weight_less_sum(mass, splat<Pack>(task.gravity[j]), load_in_double<Pack>(sum));
      store(sum, PackOf<Real, width>{});
    }
  }
  template <class Real>
  [[gnu::always_inline]] static void force_of_components(const NodeForces<Real>& task,
                                                         std::int64_t i, double* force) {
    Pack f[3], by_node[3];
    take_components(task, i, f);
    order_by_node(f, by_node);
    for (int r = 0; r < 3; ++r) store(force + r * width, by_node[r]);
  }

  template <class Real>
  static void add_component_places(Real* sum, std::int64_t stride, std::int64_t place,
                                   const std::int32_t* node, std::int64_t n) {
    Real* from = sum + place;
    for_pieces(
        node, n, [&](std::int64_t i, auto is_eight) __attribute__((always_inline)) {
          constexpr int n_nodes = is_eight ? eight : 1, at_once = is_eight ? width : 1;
          using Some = PackOf<Real, at_once>;
          for (int j = 0; j < 3; ++j)
            for (int l = 0; l < n_nodes; l += at_once) {
              Real* const to = sum + j * stride + i + l;
              Real* const of_place = from + j * stride + l;
              store(to, Some(load<Some>(to) + load<Some>(of_place)));
              store(of_place, Some{});
            }
          from += n_nodes;
        });
  }

  // Of the components in the r-th register of three.
  template <int r, class Real>
  [[gnu::always_inline]] static Pack gravity_of(const NodeForces<Real>& task) {
    Pack g{};
    if constexpr (width == 8) {
      const double x = task.gravity[width * r % 3], y = task.gravity[(width * r + 1) % 3],
                   z = task.gravity[(width * r + 2) % 3];
      g = Pack{x, y, z, x, y, z, x, y};
    }
    return g;
  }

  template <int r>
  [[gnu::always_inline]] static void store_force(const Pack& gravity, const Pack& mass,
                                                 const Pack& sum, double* force) {
    const Pack m = of_components<r>(mass, std::make_index_sequence<width>{});
    store(force + r * width, weight_less_sum(m, gravity, sum));
  }

  // force_of_node of nodes that follow each other, by whole registers.
  template <class Real>
  [[gnu::always_inline]] static void force_of_eight(const Pack (&gravity)[3], const double* mass,
                                                    Real* sum, double* force) {
    const Pack m = load<Pack>(mass);
    Pack s[4];  // two nodes each, x y z 0
    for (int k = 0; k < 4; ++k) s[k] = load_in_double<Pack>(sum + k * width);
    store_force<0>(gravity[0], m, __builtin_shufflevector(s[0], s[1], 0, 1, 2, 4, 5, 6, 8, 9),
                   force);
    store_force<1>(gravity[1], m, __builtin_shufflevector(s[1], s[2], 2, 4, 5, 6, 8, 9, 10, 12),
                   force);
    store_force<2>(gravity[2], m, __builtin_shufflevector(s[2], s[3], 5, 6, 8, 9, 10, 12, 13, 14),
                   force);
    using Part = PackOf<Real, lanes_of_block<Real>>;
    for (int k = 0; k < 4 * width; k += lanes_of_block<Real>) store(sum + k, Part{});
  }

  // Of `width` nodes, the factor of each component in the r-th register of three.
  template <int r, std::size_t... k>
  [[gnu::always_inline]] static Pack of_components(const Pack& x, std::index_sequence<k...>) {
    if constexpr (width == 1)
      return x;
    else
      return __builtin_shufflevector(x, x, (r * sizeof...(k) + k) / 3 ...);
  }

  [[gnu::always_inline]] static void hold(const Nodes& nodes) {
    for (int k = 0; k < 3 * width; ++k)
      if ((nodes.fixed[k / 3] >> k % 3 & 1) != 0) nodes.v[k] = 0;
  }

  [[gnu::always_inline]] static bool is_any_fixed(const Nodes& nodes) {
    std::conditional_t<width == 8, std::uint64_t, std::uint8_t> any = 0;
    if constexpr (width == 8) {
      __builtin_memcpy(&any, nodes.fixed, sizeof any);
    } else {
      for (int l = 0; l < width; ++l) any = static_cast<std::uint8_t>(any | nodes.fixed[l]);
    }
    return any != 0;
  }

  template <bool is_eight>
  [[gnu::always_inline]] static bool any_waits(const std::uint8_t* fixed,
                                               std::bool_constant<is_eight>) {
    if constexpr (!is_eight) return (*fixed & waits) != 0;
    std::uint64_t all;
    __builtin_memcpy(&all, fixed, sizeof all);
    return __builtin_expect((all & (~std::uint64_t{0} / 0xFF * waits)) != 0, false);
  }

  // Of n nodes from the first on those that don't wait; of the others the force is kept. What it
  // takes are copies, so that the caller has its own in registers.
  [[gnu::noinline]] static void move_others(NodeMotion task, Forces force, std::int64_t first,
                                            int n, double* kept) {
    for (int l = 0; l < n; ++l) {
      const Nodes node = nodes_from(task, first + l, force.of + 3 * l);
      if ((*node.fixed & waits) != 0)
        for (int j = 0; j < 3; ++j) kept[3 * l + j] = node.force[j];
      else
        move_one(task, node);
    }
  }

  [[gnu::always_inline]] static void move(const Factors& by, const Nodes& nodes) {
    constexpr auto lanes = std::make_index_sequence<width>{};
    const Pack gain = by.gain / load<Pack>(nodes.inertia);
    move(by, nodes,
         {Pack(of_components<0>(gain, lanes) * load<Pack>(nodes.force)),
          Pack(of_components<1>(gain, lanes) * load<Pack>(nodes.force + width)),
          Pack(of_components<2>(gain, lanes) * load<Pack>(nodes.force + 2 * width))});
  }

  // The same of sums by component.
  template <class Real>
  [[gnu::always_inline]] static void move_components(const NodeForces<Real>& task,
                                                     const Factors& by, const Nodes& nodes,
                                                     std::int64_t i) {
    Pack f[3], gained[3];
    take_components(task, i, f);
    const Pack gain = by.gain / load<Pack>(nodes.inertia);
    for (int j = 0; j < 3; ++j) f[j] = gain * f[j];
    order_by_node(f, gained);
    move(by, nodes, gained);
  }

  // gained: velocity, of the forces. All is read before anything is written: where arrays lie a
  // multiple of 4096 bytes apart, a read behind a write to the other one waits for it (8.3 in place
  // of 3.5 us for 4,600 nodes).
  [[gnu::always_inline]] static void move(const Factors& by, const Nodes& nodes,
                                          const Pack (&gained)[3]) {
    Pack v[3], u[3];
    for (int r = 0; r < 3; ++r)
      v[r] = product_plus(by.keep, load<Pack>(nodes.v + r * width), gained[r]);
    for (int r = 0; r < 3; ++r) u[r] = load<Pack>(nodes.u + r * width);
    for (int r = 0; r < 3; ++r) store(nodes.v + r * width, v[r]);
    if (is_any_fixed(nodes)) {
      hold(nodes);
      for (int r = 0; r < 3; ++r) v[r] = load<Pack>(nodes.v + r * width);
    }
    for (int r = 0; r < 3; ++r) store(nodes.u + r * width, product_plus(by.dt, v[r], u[r]));
  }

  // One node, rounded alike.
  [[gnu::always_inline]] static void move_one(const NodeMotion& task, const Nodes& nodes) {
    const double gain = task.gain / *nodes.inertia;
    for (int j = 0; j < 3; ++j) {
      const bool is_fixed = (*nodes.fixed >> j & 1) != 0;
      const double v = product_plus(task.keep, nodes.v[j], gain * nodes.force[j]);
      nodes.v[j] = is_fixed ? 0 : v;
      nodes.u[j] = product_plus(task.dt, nodes.v[j], nodes.u[j]);
    }
  }
};

template <class Pack>
NodeKernels node_kernels() {
  using Loops = NodeLoops<Pack>;
  return {Loops::template force<double>,
          Loops::template force<float>,
          Loops::template step<double>,
          Loops::template step<float>,
          Loops::template add_places<double>,
          Loops::template add_places<float>,
          Loops::motion,
          WorkLoops<Pack>::add,
          Loops::split};
}

}  // namespace trocar
