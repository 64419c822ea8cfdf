// Orders of a mesh's nodes and elements that the schemes of a step are compared in.
#pragma once

#include <array>

#include "mesh/mesh.h"

namespace trocar {

// As given; anyhow; reverse Cuthill-McKee (mesh/renumber.h); along Hilbert's curve. In all of them
// tetrahedra are interleaved as the program has them.
enum class MeshOrder { given, shuffled, cuthill_mckee, hilbert };
inline constexpr std::array<const char*, 4> order_names = {"given", "shuffled", "cuthill-mckee",
                                                           "hilbert"};

// Without node sets; expects a mesh that no cut has made copies in.
Mesh in_order(MeshOrder order, const Mesh& mesh);

}  // namespace trocar
