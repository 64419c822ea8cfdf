// Pulls the nodes of the opened facets onto the swept surface and lets their neighbours make room,
// by descent on the energy of cut_energy.h. No element loses its volume, or stable step below the
// floor.
#pragma once

#include <cstdint>
#include <vector>

#include "cutting/cut_label.h"

namespace trocar {

enum class NodeRole : std::uint8_t { stays, makes_room, on_surface };

struct MoveLimits {
  double floor = 0;  // no element's step bound may sink below this, or sink further [m]
  double snap = 0;   // nor below this only to put a node on the surface that descent left beside it
};

// Moves the patch's nodes from where they are in X, reference positions.
void move_nodes(const CutSurroundings& around, const std::vector<NodeRole>& role,
                const MoveLimits& limits, std::vector<Vec3>& X);

// The nearest point to X that node i may go to and that is on the swept surface; X if there is
// none.
Vec3 foot_on_surface(const CutSurroundings& around, std::int32_t i, const Vec3& X);

// Distance of node i from the swept surface if it stood at X; 0 where no crossing is near. [m]
double surface_distance(const CutSurroundings& around, std::int32_t i, const Vec3& X);

}  // namespace trocar
