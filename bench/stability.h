// The stress tests of the solver's stability: each case is a configuration, what is promised of it,
// and what was measured.
#pragma once

#include <string>
#include <vector>

namespace trocar {

struct StabilityRow {
  std::string configuration, promise, measured;
  bool is_kept = false;
};

// scale: share of the full step counts, 1 for all of them.
using StabilityCase = std::vector<StabilityRow> (*)(double scale);

std::vector<StabilityRow> steps_around_the_limit(double scale);
std::vector<StabilityRow> third_order_resonance(double scale);
std::vector<StabilityRow> nearly_incompressible(double scale);
std::vector<StabilityRow> confined_compression(double scale);
std::vector<StabilityRow> inversion_and_recovery(double scale);
std::vector<StabilityRow> nodal_noise(double scale);
std::vector<StabilityRow> stiffness_jumps(double scale);
std::vector<StabilityRow> slivers(double scale);
std::vector<StabilityRow> shards(double scale);
std::vector<StabilityRow> gravity_flip(double scale);
std::vector<StabilityRow> free_fall(double scale);
std::vector<StabilityRow> long_vibration(double scale);
std::vector<StabilityRow> local_time_steps(double scale);
std::vector<StabilityRow> non_finite_values(double scale);
std::vector<StabilityRow> struck_layers(double scale);
std::vector<StabilityRow> pinched_sheet(double scale);
std::vector<StabilityRow> withdrawn_ball(double scale);
std::vector<StabilityRow> jumping_support(double scale);
std::vector<StabilityRow> jumping_load(double scale);

}  // namespace trocar
