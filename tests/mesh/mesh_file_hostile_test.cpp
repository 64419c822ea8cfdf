// Files that are cut off, damaged or made to do harm: an InputError or a mesh, never anything else.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "base/error.h"
#include "error_of.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "mesh/vtu_file.h"
#include "mesh_equal.h"
#include "mesh_sample_files.h"
#include "test_files.h"

namespace trocar::test {
namespace {

// What write_vtu makes of the sample, so that zlib blocks are among the formats.
std::vector<SampleFile> all_volume_files(const TestFolder& folder) {
  std::vector<SampleFile> samples = sample_files();
  const Mesh mesh = sample_mesh();
  write_vtu(mesh, mesh.X, {}, {}, folder.file("zlib.vtu"));
  std::ifstream in(folder.file("zlib.vtu"), std::ios::binary);
  samples.push_back({"zlib.vtu", std::string(std::istreambuf_iterator<char>(in), {})});
  return samples;
}

// The mesh, or nothing if it is refused; any other exception fails the test.
std::vector<Mesh> read_or_refuse(const std::string& file) {
  try {
    return {read_mesh(file, 1)};
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(file)) << error.what();
    return {};
  }
}

TEST(HostileMeshFile, cut_off_anywhere_it_is_refused_or_reads_the_same) {
  const TestFolder folder;
  for (const SampleFile& sample : all_volume_files(folder)) {
    SCOPED_TRACE(sample.name);
    const Mesh whole = read_mesh(folder.file("whole", sample.content), 1);
    for (std::size_t n = 0; n < sample.content.size(); ++n) {
      const auto cut = read_or_refuse(folder.file("cut.msh", sample.content.substr(0, n)));
      EXPECT_TRUE(cut.empty() || cut[0] == whole) << "cut to " << n << " bytes";
    }
  }
}

TEST(HostileMeshFile, cut_off_before_the_last_element_it_is_refused) {
  const TestFolder folder;
  for (const SampleFile& sample : all_volume_files(folder)) {
    SCOPED_TRACE(sample.name);
    EXPECT_TRUE(
        read_or_refuse(folder.file("cut.msh", sample.content.substr(0, sample.content.size() / 2)))
            .empty());
  }
}

TEST(HostileMeshFile, a_surface_cut_off_anywhere_is_refused_or_smaller) {
  const TestFolder folder;
  for (const std::string& content : {stl_ascii(), stl_binary(), obj()})
    for (std::size_t n = 0; n < content.size(); ++n) {
      const std::string file =
          folder.file(content == obj() ? "a.obj" : "a.stl", std::string_view(content).substr(0, n));
      try {
        EXPECT_LE(read_triangle_mesh(file, 1).triangle.size(), 4U);
      } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(file)) << error.what();
      }
    }
}

// A mesh that gets through must be sound but for what several elements do together.
void expect_sound(const Mesh& mesh) {
  ASSERT_EQ(mesh.corner_offset.size(), mesh.element_type.size());
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e) {
    for (const std::int32_t i : mesh.corners(e)) ASSERT_TRUE(i >= 0 && i < mesh.n_nodes());
    ASSERT_GT(element_volume(mesh, e, mesh.X), 0);
  }
}

std::string damaged(const std::string& content, std::mt19937& random) {
  std::string result = content;
  const auto n = 1 + random() % 3;
  for (unsigned k = 0; k < n; ++k) {
    const std::size_t at = random() % result.size();
    const char digit = static_cast<char>('0' + random() % 10);
    switch (random() % 4) {
      case 0:
        result[at] = static_cast<char>(result[at] ^ (1U << random() % 8));
        break;
      case 1:
        result[at] = static_cast<char>(random());
        break;
      case 2:
        result.insert(at, 1, digit);
        break;
      default:
        result[at] = digit;
    }
  }
  return result;
}

TEST(HostileMeshFile, damaged_bytes_never_crash) {
  const TestFolder folder;
  std::mt19937 random(1);
  for (const SampleFile& sample : all_volume_files(folder))
    for (int k = 0; k < 1500; ++k)
      for (const Mesh& mesh : read_or_refuse(folder.file("x.msh", damaged(sample.content, random))))
        expect_sound(mesh);
}

TEST(HostileMeshFile, damaged_surfaces_never_crash) {
  const TestFolder folder;
  std::mt19937 random(2);
  for (const std::string& content : {stl_ascii(), stl_binary(), obj()})
    for (int k = 0; k < 1500; ++k) {
      const std::string file =
          folder.file(content == obj() ? "a.obj" : "a.stl", damaged(content, random));
      try {
        const TriangleMesh mesh = read_triangle_mesh(file, 1);
        for (const auto& triangle : mesh.triangle)
          for (const std::int32_t i : triangle)
            ASSERT_TRUE(i >= 0 && static_cast<std::size_t>(i) < mesh.X.size());
      } catch (const InputError&) {
      }
    }
}

// Peak resident memory of this process so far. [byte]
long peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024;
}

TEST(HostileMeshFile, huge_counts_are_refused_before_memory_is_taken) {
  const TestFolder folder;
  const std::string counts[] = {
      "0", "-1", "2147483647", "2147483648", "2305843009213693952", "99999999999999999999"};
  const long before = peak_memory();
  for (const std::string& n : counts) {
    const std::string files[] = {
        "$NOD\n" + n + "\n1 0 0 0\n$ENDNOD\n",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" + n + "\n",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n" + n +
            "\n1 4 " + n + " 1 1 1 1\n",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 4 " +
            n + " 1 1 1 1\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 " + n + " 0 0\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n" + n + " " + n + " 1 1\n3 1 0 " + n + "\n",
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n3 1 0 " + n + "\n",
        vtk_head("3.0", "ASCII") + "POINTS " + n + " float\n0 0 0\n",
        vtk_head("3.0", "BINARY") + "POINTS " + n + " float\n0 0 0\n",
        vtk_head("3.0", "ASCII") + "POINTS 1 float\n0 0 0\nCELLS " + n + " " + n + "\n",
        vtk_head("5.1", "ASCII") + "FIELD a " + n + "\nb " + n + " " + n + " double\n",
        vtk_head("5.1", "BINARY") + "FIELD a 1\nb " + n + " " + n + " double\n",
        "<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"" + n + "\" NumberOfCells=\"" +
            n +
            "\"><Points><DataArray type=\"Float64\" format=\"ascii\">0"
            "</DataArray></Points></Piece></VTKFile>"};
    for (const std::string& content : files)
      EXPECT_TRUE(read_or_refuse(folder.file("x.msh", content)).empty()) << content;
  }
  EXPECT_LT(peak_memory() - before, 64L << 20);  // the promise: 4 times the file + 64 MB
}

TEST(HostileMeshFile, fewer_bits_than_none_are_refused) {
  const TestFolder folder;
  const std::string file =
      folder.file("x.vtk", vtk_head("5.1", "BINARY") + "FIELD a 1\nb 1 -1 bit\n");
  const std::string error = error_of([&] { read_mesh(file, 1); });
  EXPECT_NE(error.find("bits"), std::string::npos) << error;
}

TEST(HostileMeshFile, a_pipe_is_refused_instead_of_waited_for) {
  const TestFolder folder;
  const std::string file = folder.file("pipe.msh");
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_NE(error_of([&] { read_mesh(file, 1); }).find("is not a regular file"), std::string::npos);
}

}  // namespace
}  // namespace trocar::test
