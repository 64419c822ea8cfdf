// Lists of elements and what each lane holds: what build_model and edit_model have in common.
#pragma once

#include <cstdint>
#include <span>

#include "solver/element_setup.h"
#include "solver/model_edit.h"

namespace trocar {

// Of the list that an element of the mesh belongs to; lists are in the order of their keys.
std::size_t list_key(const ModelSource& source, std::int32_t e);
std::size_t list_key(const ElementBlocks& blocks);

// With room for its lanes, all numbers zero.
ElementBlocks empty_blocks(const ModelSource& source, std::size_t key, std::int32_t n_elements);

// Volume, step and numbers of an element of the mesh.
ElementConstants constants_of(const ModelSource& source, std::int32_t e);
// [s]; 0 where the element is broken.
double resting_step(const ElementConstants& constants, double stiffening);

// Corners of the lane's element, which a lane behind the last element repeats.
void fill_corners(const ModelSource& source, std::int64_t lane, ElementBlocks& blocks);
// Corners, numbers and stable step of the lane's element; all numbers behind the last one are zero.
void fill_lane(const ModelSource& source, std::int64_t lane, ElementBlocks& blocks,
               std::vector<double>& element_step);
// Throws InputError if element k of the part has no stable step.
void check_step(const ModelSource& source, std::size_t k, const Model& model);

// model.mass and model.fixed get the length of the part's nodes.
void resize_nodes(const Part& part, Model& model);
// What a plane body holds at every node: z.
FixedMask held_by_plane(const Mesh& mesh);
// Mass and supports of owned node i. Throws InputError if it has no mass.
void take_node(const ModelSource& source, std::int32_t i, FixedMask plane, Model& model);
// model.position, if the lists read it.
void take_positions(const ModelSource& source, Model& model);

}  // namespace trocar
