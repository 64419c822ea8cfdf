// New nodes on crossed edges: the tetrahedra around such an edge are bisected there.
#pragma once

#include <vector>

#include "cutting/cut_patch.h"
#include "cutting/cut_stroke.h"
#include "mesh/edit.h"

namespace trocar {

// Bisects edges one after the other, ascending by their ends, so that neighbours agree: a
// tetrahedron of which the blade crossed all edges between two sides becomes six at most.
// `inserted` ascends by ends; `element`, ascending: at least all that have one of the edges.
MeshEdit split_edges(const Mesh& mesh, std::span<const std::int32_t> element,
                     std::vector<EdgeNode> inserted);

// The stroke that inserts the nodes takes up its edit: parts that lie on one side of the blade get
// it, and all are looked at again. mesh: before it.
void split_stroke(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke);

// What a stroke remembers, after an edit that inserts nodes. mesh: before it.
void follow_splits(const Mesh& mesh, const MeshEdit& edit, CutStroke& stroke);

}  // namespace trocar
