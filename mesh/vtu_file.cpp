// Writing VTU and PVD for ParaView. Appended data over 4 kB do not open in Debian 12's ParaView, so
// all arrays stand inline.
#include "mesh/vtu_file.h"

#include <bit>

#include "base/check.h"
#include "base/number_text.h"
#include "base/whole_file.h"
#include "mesh/vtu_data.h"
#include "mesh/xml_tag.h"

namespace trocar {

namespace {

struct ArrayHead {
  std::string_view type;  // "Float64"
  std::string_view name;
  int width = 1;
};

template <class Number>
void append_array(std::string& text, const ArrayHead& head, std::span<const Number> values) {
  text.append("<DataArray type=\"").append(head.type);
  text.append("\" Name=\"").append(escaped_xml(head.name)).append("\" NumberOfComponents=\"");
  text += std::to_string(head.width) + "\" format=\"binary\">";
  append_vtu_data({reinterpret_cast<const char*>(values.data()), values.size_bytes()}, text);
  text += "</DataArray>\n";
}

void append_fields(std::string& text, std::span<const VtuField> fields, std::size_t n) {
  for (const VtuField& field : fields) {
    CHECK_OP(field.values.size(), ==, n * static_cast<std::size_t>(field.width));
    append_array(text, {"Float64", field.name, field.width}, field.values);
  }
}

void append_cells(std::string& text, const Mesh& mesh) {
  constexpr std::array<std::uint8_t, n_element_types> vtk_type = {5, 10, 12};
  std::vector<std::uint8_t> type;
  std::vector<std::int32_t> connectivity, end;
  type.reserve(mesh.element_type.size());
  connectivity.reserve(mesh.corner_node.size());
  end.reserve(mesh.element_type.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    const std::span<const std::int32_t> node = mesh.corners(e);
    type.push_back(vtk_type[static_cast<std::size_t>(mesh.element_type[e])]);
    connectivity.insert(connectivity.end(), node.begin(), node.end());
    end.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  text += "<Cells>\n";
  append_array<std::int32_t>(text, {"Int32", "connectivity"}, connectivity);
  append_array<std::int32_t>(text, {"Int32", "offsets"}, end);
  append_array<std::uint8_t>(text, {"UInt8", "types"}, type);
  text += "</Cells>\n";
}

void append_head(std::string& text, std::string_view type) {
  const bool is_big = std::endian::native == std::endian::big;
  text.append("<?xml version=\"1.0\"?>\n<VTKFile type=\"").append(type);
  text.append("\" version=\"1.0\" byte_order=\"").append(is_big ? "BigEndian" : "LittleEndian");
  text += "\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n";
}

}  // namespace

void write_vtu(const Mesh& mesh, std::span<const Vec3> x, std::span<const VtuField> nodal,
               std::span<const VtuField> elemental, const std::string& file) {
  CHECK_OP(x.size(), ==, mesh.X.size());
  std::string text;
  append_head(text, "UnstructuredGrid");
  text += "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(mesh.n_nodes());
  text += "\" NumberOfCells=\"" + std::to_string(mesh.n_elements());
  text += "\">\n<PointData>\n";
  append_fields(text, nodal, mesh.X.size());
  text += "</PointData>\n<CellData>\n";
  append_array<std::int32_t>(text, {"Int32", "region"}, mesh.element_region);
  const std::span<const double> fibre(mesh.fibre.empty() ? nullptr : mesh.fibre[0].data(),
                                      3 * mesh.fibre.size());
  if (!fibre.empty()) append_array(text, {"Float64", "fibre", 3}, fibre);
  append_fields(text, elemental, mesh.element_type.size());
  text += "</CellData>\n<Points>\n";
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const std::span<const double> coordinates(x.empty() ? nullptr : x[0].data(), 3 * x.size());
  append_array(text, {"Float64", "Points", 3}, coordinates);
  text += "</Points>\n";
  append_cells(text, mesh);
  text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_whole_file(file, text);
}

void write_pvd(std::span<const PvdEntry> entries, const std::string& file) {
  std::string text;
  append_head(text, "Collection");
  text += "<Collection>\n";
  for (const PvdEntry& entry : entries) {
    text += "<DataSet timestep=\"" + shortest_text(entry.time);
    text.append("\" part=\"0\" file=\"").append(escaped_xml(entry.file)).append("\"/>\n");
  }
  text += "</Collection>\n</VTKFile>\n";
  write_whole_file(file, text);
}

}  // namespace trocar
