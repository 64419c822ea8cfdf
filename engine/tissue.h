// The body of a scene: read or generated on rank 0, placed, checked, and sent to every rank.
#pragma once

#include "base/communicator.h"
#include "engine/scene.h"
#include "mesh/mesh.h"

namespace trocar {

// Collective; InputErrors of rank 0 are thrown on every rank. The mesh is validated and has all
// node sets of [[region]].
Mesh load_tissue(const LoadedScene& loaded, Communicator& communicator);

// Of each region of the mesh; those that the scene names must be there.
std::vector<Material> region_materials(const SceneTissue& tissue, const Mesh& mesh);

// The path of a file that the scene names: relative ones start at the scene file's folder.
std::string scene_path(const LoadedScene& loaded, const std::string& file);

// Warns if a body or an instrument of these points, read from a file, is far from the size of one:
// the file has another unit, as a rule, than `key` of the scene says.
void warn_of_size(const std::string& file, const std::string& key, std::span<const Vec3> X);

}  // namespace trocar
