// A recorded frame as a VTU file, with what follows from its displacements.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/recording.h"
#include "mesh/vtu_file.h"
#include "solver/material.h"

namespace trocar {

// Of each element, at its centre; tensors by 9.
struct ElementFields {
  std::vector<double> touches_cut, det_F, green_strain;
  std::vector<double> piece;                            // from 0 on, by the lowest node of each
  std::vector<double> density;                          // as mass counts it [kg/m^3]
  std::vector<double> cauchy_stress, von_mises_stress;  // of the laws, without what relaxes [Pa]
};
// u (n_nodes * 3). materials (n_regions), or none: without density and stresses, as of a plane body
// whose thickness is free.
ElementFields element_fields(const Mesh& mesh, std::span<const double> u,
                             std::span<const Material> materials);

// Into a folder that is there.
PvdEntry write_frame_vtu(const Mesh& mesh, const RecordedFrame& frame,
                         std::span<const Material> materials, const std::string& folder);

}  // namespace trocar
