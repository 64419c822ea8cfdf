// Forces that don't follow what they act on, for the relaxation.
#pragma once

#include <span>

namespace trocar {

// For RelaxTask::add_load. load (n_owned * 3) [N], which must stay.
inline auto dead_load(std::span<const double> load) {
  return [load](double share, std::span<double> force) {
    for (std::size_t k = 0; k < load.size(); ++k) force[k] += share * load[k];
  };
}

}  // namespace trocar
