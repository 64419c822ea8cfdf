#include "engine/frame_vtu.h"

#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "engine/element_gradient.h"
#include "mesh/connected_nodes.h"
#include "solver/material_setup.h"
#include "solver/material_stress.h"

namespace trocar {

static void add_tensor(const Mat3& tensor, std::vector<double>& values) {
  values.insert(values.end(), tensor.data(), tensor.data() + tensor.size());
}

// sigma = P F^T / J; von Mises: sqrt(3/2) |dev sigma|.
static void add_stress(const Material& material, const Vec3& fibre, const Mat3& H,
                       ElementFields& fields) {
  const Mat3 F = Mat3::Identity() + H;
  const Mat3 sigma = first_piola_stress(material, fibre, H) * F.transpose() / F.determinant();
  const Mat3 deviator = sigma - sigma.trace() / 3 * Mat3::Identity();
  add_tensor(sigma, fields.cauchy_stress);
  fields.von_mises_stress.push_back(std::sqrt(1.5) * deviator.norm());
}

// Of each element: the number of its piece, those counted by the lowest node of each.
static std::vector<double> piece_of_elements(const Mesh& mesh) {
  const std::vector<std::int32_t> root = connected_nodes(mesh);
  std::vector<double> number(root.size(), 0), piece;
  double n = 0;
  for (std::size_t i = 0; i < root.size(); ++i)
    if (std::cmp_equal(root[i], i)) number[i] = n++;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    piece.push_back(number[root[mesh.corners(e)[0]]]);
  return piece;
}

ElementFields element_fields(const Mesh& mesh, std::span<const double> u,
                             std::span<const Material> materials) {
  ElementFields fields;
  fields.piece = piece_of_elements(mesh);
  const auto u_of = [&](std::int32_t i) -> Vec3 {
    return Vec3::Map(&u[3 * static_cast<std::size_t>(i)]);
  };
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const Mat3 H = displacement_gradient(mesh, e, u_of), F = Mat3::Identity() + H;
    fields.touches_cut.push_back(mesh.cut_facets[e] ? 1 : 0);
    fields.det_F.push_back(F.determinant());
    add_tensor(0.5 * (F.transpose() * F - Mat3::Identity()), fields.green_strain);
    if (materials.empty()) continue;
    const Material& material = materials[mesh.element_region[e]];
    fields.density.push_back(material.density * mesh.density_factor[e]);
    add_stress(material, mesh.fibre.empty() ? unit_fibre(material) : mesh.fibre[e], H, fields);
  }
  return fields;
}

PvdEntry write_frame_vtu(const Mesh& mesh, const RecordedFrame& frame,
                         std::span<const Material> materials, const std::string& folder) {
  const ElementFields fields = element_fields(mesh, frame.u, materials);
  const VtuField nodal[] = {{.name = "displacement", .width = 3, .values = frame.u}};
  std::vector<VtuField> elemental = {
      {.name = "touches_cut", .width = 1, .values = fields.touches_cut},
      {.name = "piece", .width = 1, .values = fields.piece},
      {.name = "det_F", .width = 1, .values = fields.det_F},
      {.name = "green_strain", .width = 9, .values = fields.green_strain}};
  if (!materials.empty()) {
    elemental.push_back({.name = "density", .width = 1, .values = fields.density});
    elemental.push_back({.name = "cauchy_stress", .width = 9, .values = fields.cauchy_stress});
    elemental.push_back(
        {.name = "von_mises_stress", .width = 1, .values = fields.von_mises_stress});
  }
  const std::string name = "frame_" + with_zeros(frame.frame, 6) + ".vtu";
  write_vtu(mesh, present_positions(mesh.X, frame.u), nodal, elemental, folder + "/" + name);
  return {.time = frame.time, .file = name};
}

}  // namespace trocar
