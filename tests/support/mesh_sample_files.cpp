#include "mesh_sample_files.h"

namespace trocar::test {

Mesh sample_mesh() {
  Mesh mesh;
  mesh.X = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.region_name = {"tissue", "tumor"};
  add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{0, 1, 2, 3}, 0);
  add_element(mesh, ElementType::tet4, std::vector<std::int32_t>{1, 2, 3, 4}, 1);
  mesh.node_sets = {{"attachment", {0, 1, 2}}};
  return mesh;
}

Mesh sample_mesh_without_groups() {
  Mesh mesh = sample_mesh();
  mesh.region_name = {""};
  mesh.element_region = {0, 0};
  mesh.node_sets.clear();
  return mesh;
}

std::string physical_names() {
  return "$PhysicalNames\n3\n2 3 \"attachment\"\n3 2 \"tissue\"\n3 5 \"tumor\"\n"
         "$EndPhysicalNames\n";
}

std::string gmsh_1() {
  return "$NOD\n6\n10 0 0 0\n20 1 0 0\n7 0 1 0\n40 0 0 1\n50 1 1 1\n99 7 7 7\n$ENDNOD\n"
         "$ELM\n3\n1 2 3 1 3 10 20 7\n2 4 2 1 4 10 20 7 40\n3 4 5 1 4 20 7 40 50\n$ENDELM\n";
}

std::string gmsh_2_ascii() {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + physical_names() +
         "$Nodes\n6\n10 0 0 0\n20 1 0 0\n7 0 1 0\n40 0 0 1\n50 1 1 1\n99 7 7 7\n$EndNodes\n"
         "$Elements\n3\n1 2 2 3 1 10 20 7\n2 4 2 2 1 10 20 7 40\n3 4 2 5 1 20 7 40 50\n"
         "$EndElements\n";
}

std::string gmsh_2_binary() {
  std::string f = "$MeshFormat\n2.2 1 8\n";
  put<std::int32_t>(f, 1);
  f += "\n$EndMeshFormat\n" + physical_names() + "$Nodes\n6\n";
  for (int i = 0; i < 6; ++i) {
    put(f, sample_tag[i]);
    for (const double x : sample_X[i]) put(f, x);
  }
  f += "\n$EndNodes\n$Elements\n3\n";
  for (const std::int32_t k : {2, 1, 2, 1, 3, 1, 10, 20, 7}) put(f, k);
  for (const std::int32_t k : {4, 2, 2, 2, 2, 1, 10, 20, 7, 40, 3, 5, 1, 20, 7, 40, 50}) put(f, k);
  return f + "\n$EndElements\n";
}

std::string gmsh_4_ascii() {
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + physical_names() +
         "$Entities\n0 0 1 2\n4 0 0 0 1 1 0 1 3 0\n"
         "1 0 0 0 1 1 1 1 2 1 4\n2 0 0 0 1 1 1 1 5 0\n$EndEntities\n"
         "$Nodes\n2 6 7 99\n2 4 1 3\n10\n20\n7\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n"
         "3 1 0 3\n40\n50\n99\n0 0 1\n1 1 1\n7 7 7\n$EndNodes\n"
         "$Elements\n3 3 1 3\n2 4 2 1\n1 10 20 7\n3 1 4 1\n2 10 20 7 40\n3 2 4 1\n3 20 7 40 50\n"
         "$EndElements\n";
}

void put_entity(std::string& f, std::int32_t tag, std::int32_t physical) {
  put(f, tag);
  for (const double x : {0., 0., 0., 1., 1., 1.}) put(f, x);
  put<std::uint64_t>(f, 1);
  put(f, physical);
  put<std::uint64_t>(f, 0);
}

void put_block(std::string& f, std::int32_t a, std::int32_t b, std::int32_t c, std::uint64_t n) {
  put(f, a);
  put(f, b);
  put(f, c);
  put(f, n);
}

std::string gmsh_4_binary() {
  std::string f = "$MeshFormat\n4.1 1 8\n";
  put<std::int32_t>(f, 1);
  f += "\n$EndMeshFormat\n" + physical_names() + "$Entities\n";
  for (const std::uint64_t n : {0, 0, 1, 2}) put(f, n);
  put_entity(f, 4, 3);
  put_entity(f, 1, 2);
  put_entity(f, 2, 5);
  f += "\n$EndEntities\n$Nodes\n";
  for (const std::uint64_t n : {1, 6, 7, 99}) put(f, n);
  put_block(f, 3, 1, 0, 6);
  for (const std::int32_t tag : sample_tag) put<std::uint64_t>(f, static_cast<std::uint64_t>(tag));
  for (const auto& X : sample_X)
    for (const double x : X) put(f, x);
  f += "\n$EndNodes\n$Elements\n";
  for (const std::uint64_t n : {3, 3, 1, 3}) put(f, n);
  put_block(f, 2, 4, 2, 1);
  for (const std::uint64_t k : {1, 10, 20, 7}) put(f, k);
  put_block(f, 3, 1, 4, 1);
  for (const std::uint64_t k : {2, 10, 20, 7, 40}) put(f, k);
  put_block(f, 3, 2, 4, 1);
  for (const std::uint64_t k : {3, 20, 7, 40, 50}) put(f, k);
  return f + "\n$EndElements\n";
}

std::string vtk_head(const std::string& version, const std::string& kind) {
  return "# vtk DataFile Version " + version + "\na title\n" + kind +
         "\nDATASET UNSTRUCTURED_GRID\n";
}

std::string vtk_4_ascii() {
  return vtk_head("3.0", "ASCII") +
         "POINTS 6 float\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1 7 7 7\n\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n"
         "4 1 2 3 4\n\nCELL_TYPES 3\n5\n10\n10\nCELL_DATA 3\nSCALARS s float 1\n"
         "LOOKUP_TABLE default\n0.5 nan 2\n";
}

std::string vtk_5_ascii() {
  return vtk_head("5.1", "ASCII") +
         "FIELD FieldData 1\nTIME 1 1 double\n0.5\nMETADATA\nINFORMATION 0\n\n"
         "POINTS 6 double\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1 7 7 7\nMETADATA\nINFORMATION 0\n\n"
         "CELLS 4 11\nOFFSETS vtktypeint64\n0 3 7 11\nCONNECTIVITY vtktypeint64\n"
         "0 1 2 0 1 2 3 1 2 3 4\nCELL_TYPES 3\n5\n10\n10\n";
}

std::string vtk_binary_points() {
  std::string f = "POINTS 6 double\n";
  for (const auto& X : sample_X) put_all<double>(f, X);
  return f + "\n";
}

std::string vtk_binary_types() {
  std::string f = "CELL_TYPES 3\n";
  put_all<std::int32_t>(f, std::vector<int>{5, 10, 10});
  return f + "\n";
}

std::string vtk_4_binary() {
  std::string f = vtk_head("4.2", "BINARY") + vtk_binary_points() + "CELLS 3 14\n";
  put_all<std::int32_t>(f, std::vector<int>{3, 0, 1, 2, 4, 0, 1, 2, 3, 4, 1, 2, 3, 4});
  return f + "\n" + vtk_binary_types();
}

std::string vtk_5_binary() {
  std::string f = vtk_head("5.1", "BINARY") + "FIELD FieldData 1\nTIME 1 1 double\n";
  put_all<double>(f, std::vector<double>{0.5});
  f += "\nMETADATA\nINFORMATION 0\n\n" + vtk_binary_points() + "METADATA\nINFORMATION 0\n\n";
  f += "CELLS 4 11\nOFFSETS vtktypeint64\n";
  put_all<std::int64_t>(f, std::vector<int>{0, 3, 7, 11});
  f += "\nCONNECTIVITY vtktypeint64\n";
  put_all<std::int64_t>(f, std::vector<int>{0, 1, 2, 0, 1, 2, 3, 1, 2, 3, 4});
  return f + "\n" + vtk_binary_types();
}

std::string vtu_ascii() {
  return "<?xml version=\"1.0\"?>\n<!-- a > comment -->\n"
         "<VTKFile type='UnstructuredGrid' version='0.1' byte_order='LittleEndian'>\n"
         "<UnstructuredGrid>\n<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n"
         "<PointData><DataArray type=\"Float32\" Name=\"region\" format=\"ascii\">1 2 3 4 5 6"
         "</DataArray></PointData>\n"
         "<Points><DataArray type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\" "
         "format=\"ascii\">\n<InformationKey name=\"L2\"><Value index=\"0\">3</Value>"
         "</InformationKey>\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1 7 7 7\n</DataArray></Points>\n"
         "<Cells>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">"
         "0 1 2 0 1 2 3 1 2 3 4</DataArray>\n"
         "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 7 11</DataArray>\n"
         "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 10 10</DataArray>\n"
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string vtu_appended_raw() {
  std::string data;
  std::vector<std::size_t> offset;
  const auto begin = [&](std::size_t n_bytes) {
    offset.push_back(data.size());
    put(data, static_cast<std::uint32_t>(n_bytes), std::endian::big);
  };
  begin(6 * 3 * 8);
  for (const auto& X : sample_X) put_all<double>(data, X);
  begin(11 * 4);
  put_all<std::int32_t>(data, std::vector<int>{0, 1, 2, 0, 1, 2, 3, 1, 2, 3, 4});
  begin(3 * 4);
  put_all<std::int32_t>(data, std::vector<int>{3, 7, 11});
  begin(3);
  put_all<std::uint8_t>(data, std::vector<int>{5, 10, 10});
  const auto array = [&](const std::string& type, const std::string& name, std::size_t k) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"appended\" offset=\"" +
           std::to_string(offset[k]) + "\"/>\n";
  };
  return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"BigEndian\" header_type=\"UInt32\">\n"
         "<UnstructuredGrid><Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n<Points>" +
         array("Float64", "Points", 0) + "</Points><Cells>" + array("Int32", "connectivity", 1) +
         array("Int32", "offsets", 2) + array("UInt8", "types", 3) +
         "</Cells></Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n  _" + data +
         "\n</AppendedData>\n</VTKFile>\n";
}

std::vector<SampleFile> sample_files() {
  return {{"gmsh_1.msh", gmsh_1(), true, false},
          {"gmsh_2_ascii.msh", gmsh_2_ascii(), true, true},
          {"gmsh_2_binary.msh", gmsh_2_binary(), true, true},
          {"gmsh_4_ascii.msh", gmsh_4_ascii(), true, true},
          {"gmsh_4_binary.msh", gmsh_4_binary(), true, true},
          {"vtk_4_ascii.vtk", vtk_4_ascii()},
          {"vtk_4_binary.vtk", vtk_4_binary()},
          {"vtk_5_ascii.vtk", vtk_5_ascii()},
          {"vtk_5_binary.vtk", vtk_5_binary()},
          {"vtu_ascii.vtu", vtu_ascii()},
          {"vtu_appended_raw.vtu", vtu_appended_raw()}};
}

std::string stl_ascii() {
  std::string f = "solid a tetrahedron\n";
  for (const auto& face : tetrahedron_face) {
    f += "facet normal 0 0 0\n outer loop\n";
    for (const int i : face) {
      f += "  vertex";
      for (const double x : sample_X[i]) f += " " + std::to_string(x);
      f += "\n";
    }
    f += " endloop\nendfacet\n";
  }
  return f + "endsolid a tetrahedron\n";
}

std::string stl_binary(const std::string& head) {
  std::string f = head;
  f.resize(80, ' ');
  put<std::uint32_t>(f, 4);
  for (const auto& face : tetrahedron_face) {
    for (int k = 0; k < 3; ++k) put(f, 0.F);
    for (const int i : face)
      for (const double x : sample_X[i]) put(f, static_cast<float>(x));
    put<std::uint16_t>(f, 0);
  }
  return f;
}

std::string obj() {
  return "# a tetrahedron\nmtllib a.mtl\no body\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nv 0 0 1\n"
         "vn 0 0 1\nvt 0 0\nf 1 3 2\nf 1/1 2/1 4/1\nf 2//1 3//1 4//1\nf -4/1/1 -1/1/1 -2/1/1\n";
}

}  // namespace trocar::test
