// Forces on the tissue without an instrument: [[load]]. A force is spread over the faces of a
// region, by their first area, and keeps its direction; pressure pushes on the faces as they are
// now, of a plane body on the present length times the present thickness. Wounds are no faces of a
// region.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cutting/cut_constraints.h"
#include "engine/scene.h"
#include "engine/tool_path.h"
#include "mesh/facets.h"
#include "mesh/partition.h"

namespace trocar {

// Nodes of a face of the surface, outward; two of a plane body, -1 fills up.
using LoadFace = std::array<std::int32_t, 4>;

struct Loads {
  // Of an owned node: the part of a load's force that acts there.
  struct Share {
    std::int32_t load = 0, place = 0;  // place in `node`
    double part = 0;
  };
  // One with owned nodes, in local numbers; place: of these in `node`, -1 of others.
  struct Face {
    std::int32_t load = 0;
    LoadFace node, place;
    // Of an edge in the plane: position in Part::element_global, and how much thicker it is than at
    // rest.
    std::int32_t element = -1;
    double stretch = 1;
  };
  std::vector<DisplacementPath> path;  // (n_loads) of the factor, as x
  std::vector<double> factor;          // (n_loads) in the present step
  std::vector<Share> shares;
  std::vector<Face> faces;         // of loads with pressure
  std::vector<std::int32_t> node;  // owned, local
  std::vector<Vec3> force;         // (node.size()) of the present step [N]
  std::vector<BorderEdge> border;  // only if something cuts
  bool is_empty() const { return path.empty(); }
};

// Faces of the uncut surface, in ascending order of (element, facet): all that a load may act on,
// and for each load those whose nodes all lie in its region.
struct LoadedAreas {
  std::vector<LoadFace> outer;
  std::vector<std::vector<LoadFace>> of_load;
};
LoadedAreas find_loaded_areas(std::span<const SceneLoad> scene, const Mesh& mesh,
                              const Surface& surface);
// After a change of part or topology.
void localise_loads(std::span<const SceneLoad> scene, const Mesh& mesh, const LoadedAreas& areas,
                    const Part& part, Loads& loads);
// Where loaded areas end on the outer surface, as a cut wants it: there a node that goes aside
// would change what a load acts on.
std::vector<BorderEdge> load_borders(const LoadedAreas& areas, const Mesh& mesh);
// Whether any is another at some time from t0 to t1.
bool do_loads_change(const Loads& loads, double t0, double t1);
// What acts at a time [s] on the body with displacements u (n_local * 3); thickness at rest [m].
void find_loads(std::span<const SceneLoad> scene, const Mesh& mesh, const Part& part,
                double thickness, double time, std::span<const double> u, Loads& loads);
void add_loads(const Loads& loads, double share, std::span<double> force);

}  // namespace trocar
