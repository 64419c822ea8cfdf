// What write_vtu writes, read_mesh and a plain look into the text find again.
#include "mesh/vtu_file.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "mesh/generate.h"
#include "mesh/mesh_file.h"
#include "mesh/vtu_data.h"
#include "mesh_equal.h"
#include "mesh_fixtures.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar::test {
namespace {

TEST(VtuFile, reads_back_positions_elements_and_regions) {
  const TestFolder folder;
  for (const BoxElements elements : {BoxElements::tet4_kuhn, BoxElements::hex8}) {
    Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {4, 3, 2}, elements);
    mesh.node_sets.clear();  // VTU has no place for them
    mesh.region_name = {"region-0", "region-1"};
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) mesh.element_region[e] = e % 2;
    for (std::int32_t e = 0; e < mesh.n_elements(); ++e) mesh.fibre.push_back(Vec3::Unit(e % 3));
    write_vtu(mesh, mesh.X, {}, {}, folder.file("a.vtu"));
    expect_equal(read_mesh(folder.file("a.vtu"), 1), mesh);
  }
}

// Calculators of other programs write floats.
TEST(VtuFile, regions_may_be_floats_that_are_whole) {
  const auto file = [](const std::string& region) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>"
           "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><Points>"
           "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
           "0 0 0 1 0 0 0 1 0 0 0 1 0 0 -1</DataArray></Points><Cells>"
           "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 0 2 1 4"
           "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray></Cells>"
           "<CellData><DataArray type=\"Float64\" Name=\"region\" format=\"ascii\">" +
           region + "</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>";
  };
  const TestFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.vtu", file("7 0")), 1);
  EXPECT_EQ(mesh.region_name[mesh.element_region[0]], "region-7");
  EXPECT_EQ(read_mesh(folder.file("b.vtu", file("7 0.5")), 1).region_name,
            std::vector<std::string>{""});
}

// As frames of a run have them.
TEST(VtuFile, fields_that_no_mesh_has_are_left_out_with_a_warning) {
  const TestFolder folder;
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {1, 1, 1}, BoxElements::hex8);
  const std::vector<double> u(3 * mesh.X.size()), stretch(1);
  write_vtu(mesh, mesh.X, {{{"displacement", 3, u}}}, {{{"stretch", 1, stretch}}},
            folder.file("a.vtu"));
  testing::internal::CaptureStderr();
  read_mesh(folder.file("a.vtu"), 1);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_NE(
      told.find("a.vtu: its cell data \"stretch\" and point data \"displacement\" are left out"),
      std::string::npos)
      << told;
}

TEST(VtuFile, points_stand_where_they_are_displaced_to) {
  const TestFolder folder;
  const Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {1, 1, 1}, BoxElements::hex8);
  std::vector<Vec3> x = mesh.X;
  for (Vec3& x_i : x) x_i += Vec3(0.5, 0, 1. / 3);
  write_vtu(mesh, x, {}, {}, folder.file("a.vtu"));
  EXPECT_EQ(read_mesh(folder.file("a.vtu"), 1).X, x);
}

TEST(VtuFile, arrays_of_more_than_one_zlib_block_read_back) {
  const TestFolder folder;
  Mesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {30, 30, 20}, BoxElements::tet4_kuhn);
  jitter(mesh, 0.1, 1);
  write_vtu(mesh, mesh.X, {}, {}, folder.file("a.vtu"));
  const Mesh back = read_mesh(folder.file("a.vtu"), 1);
  EXPECT_EQ(back.X, mesh.X);
  EXPECT_EQ(back.corner_node, mesh.corner_node);
}

// The values of a field, taken from the text between its tags.
std::vector<double> field_in(const std::string& content, const std::string& name, std::size_t n) {
  const std::size_t at = content.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return {};
  const std::size_t begin = content.find('>', at) + 1;
  const std::string_view text =
      std::string_view(content).substr(begin, content.find('<', begin) - begin);
  const VtuEncoding encoding{.is_zlib = true, .n_header_bytes = 8};
  const std::string bytes = decode_vtu_data(FileReader("f", content), encoding, text, 8 * n);
  std::vector<double> values(n);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(VtuFile, fields_stand_under_their_names) {
  const TestFolder folder;
  const Mesh mesh = sample_mesh();
  std::vector<double> velocity, quality = {0.25, 1e-300};
  for (int k = 0; k < 15; ++k) velocity.push_back(k / 7.0);
  const VtuField nodal[] = {{"velocity", 3, velocity}}, elemental[] = {{"a<b & \"c\"", 1, quality}};
  write_vtu(mesh, mesh.X, nodal, elemental, folder.file("a.vtu"));
  const std::string content = read_text(folder.file("a.vtu"));
  EXPECT_EQ(field_in(content, "velocity", 15), velocity);
  EXPECT_EQ(field_in(content, "a&lt;b &amp; &quot;c&quot;", 2), quality);
  EXPECT_LT(content.find("<PointData>"), content.find("velocity"));
  EXPECT_GT(content.find("</PointData>"), content.find("velocity"));
}

TEST(VtuFile, bytes_of_any_number_survive_base64_and_zlib) {
  std::string bytes;
  for (int n = 0; n < 40; ++n) {
    std::string text;
    append_vtu_data(bytes, text);
    const VtuEncoding encoding{.is_zlib = true, .n_header_bytes = 8};
    EXPECT_EQ(decode_vtu_data(FileReader("f", text), encoding, text, bytes.size()), bytes);
    bytes += static_cast<char>(37 * n + 200);
  }
}

// RFC 4648, section 10: the words behind a 4-byte header in one stream, as VTK writes plain arrays.
TEST(VtuFile, plain_base64_follows_the_standard) {
  const VtuEncoding encoding{};
  const auto decode = [&](const std::string& text, std::size_t n) {
    return decode_vtu_data(FileReader("f", text), encoding, text, n);
  };
  EXPECT_EQ(decode("BgAAAGZvb2Jhcg==", 6), "foobar");          // header and data in one stream
  EXPECT_EQ(decode(" BgAAAA==\n Zm9v\n YmFy ", 6), "foobar");  // header in a stream of its own
}

TEST(VtuFile, a_wrong_size_is_named) {
  const std::string text = "BgAAAGZvb2Jhcg==";
  EXPECT_EQ(error_of([&] { decode_vtu_data(FileReader("f", text), {}, text, 8); }),
            "f:1: this array has 6 bytes, but 8 follow from the numbers of points and cells");
}

TEST(VtuFile, what_would_unfold_beyond_measure_is_refused) {
  const TestFolder folder;
  const std::string file = folder.file(
      "a.vtu",
      "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><Piece "
      "NumberOfPoints=\"90000000\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
      "format=\"binary\">AQAAAA==</DataArray></Points></Piece></VTKFile>");
  EXPECT_EQ(error_of([&] { read_mesh(file, 1); }),
            file + ":1: this array would unfold to 2160000000 bytes, more than 64 times the file");
}

TEST(VtuFile, other_packers_pieces_and_data_sets_are_named) {
  const TestFolder folder;
  const auto refusal = [&](const std::string& content) {
    const std::string file = folder.file("a.vtu", content);
    return error_of([&] { read_mesh(file, 1); }).substr(file.size());
  };
  EXPECT_EQ(refusal("<VTKFile type=\"PolyData\">"),
            ":1: the VTK file holds \"PolyData\"; only UnstructuredGrid (.vtu) is read");
  EXPECT_EQ(
      refusal("<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\">"),
      ":1: the data are packed by \"vtkLZ4DataCompressor\"; save it with vtkZLibDataCompressor or "
      "without compression");
  const std::string piece = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n";
  EXPECT_EQ(refusal("<VTKFile type=\"UnstructuredGrid\">\n" + piece + piece),
            ":3: a second piece begins here; save the mesh in one piece");
}

TEST(PvdFile, lists_times_and_files) {
  const TestFolder folder;
  const PvdEntry entries[] = {{0, "a.vtu"}, {0.1, "b&c.vtu"}};
  write_pvd(entries, folder.file("a.pvd"));
  const std::string content = read_text(folder.file("a.pvd"));
  EXPECT_NE(content.find("<DataSet timestep=\"0\" part=\"0\" file=\"a.vtu\"/>"), std::string::npos);
  EXPECT_NE(content.find("<DataSet timestep=\"0.1\" part=\"0\" file=\"b&amp;c.vtu\"/>"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::test
