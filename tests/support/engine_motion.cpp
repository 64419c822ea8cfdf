#include "engine_motion.h"

namespace trocar {

Vec3 momentum(const Simulation& s) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < s.mass.size(); ++i) sum += s.mass[i] * Vec3::Map(&s.state.v[3 * i]);
  return sum;
}

}  // namespace trocar
