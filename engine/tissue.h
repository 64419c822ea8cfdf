// The body of a scene: read or generated on rank 0, placed, checked, and sent to every rank.
#pragma once

#include <algorithm>
#include <vector>

#include "base/check.h"
#include "base/communicator.h"
#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

// Collective; InputErrors of rank 0 are thrown on every rank, and so is a SharedMachineError if
// memory would not do. The mesh is validated and has all
// node sets of [[region]].
Mesh load_tissue(const LoadedScene& loaded, Communicator& communicator);

// A value of each region of the mesh: the tissue's, or what `of` makes of the region's material; of
// several the last. Those that the scene names must be there.
template <class Value, class Of>
std::vector<Value> of_regions(const SceneTissue& tissue, const Mesh& mesh, const Value& of_tissue,
                              const Of& of) {
  std::vector<Value> values(mesh.region_name.size(), of_tissue);
  for (const SceneRegionMaterial& other : tissue.region_materials) {
    const auto at = std::ranges::find(mesh.region_name, other.region);
    CHECK(at != mesh.region_name.end());
    values[at - mesh.region_name.begin()] = of(other);
  }
  return values;
}
std::vector<Material> region_materials(const SceneTissue& tissue, const Mesh& mesh);

// Warns if a body or an instrument of these points, read from a file, is far from the size of one:
// the file has another unit, as a rule, than `key` of the scene says.
void warn_of_size(const std::string& file, const std::string& key, std::span<const Vec3> X);

}  // namespace trocar
