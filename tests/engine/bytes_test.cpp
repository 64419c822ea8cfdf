#include "engine/bytes.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <new>

#include "base/error.h"
#include "engine_recording.h"
#include "error_of.h"
#include "mesh_equal.h"
#include "mesh_fixtures.h"

namespace trocar {
namespace {

TEST(Bytes, come_back_as_the_values_that_went_in) {
  ByteWriter writer;
  writer.put(std::int32_t{-7});
  writer.put(0.1);
  writer.put_text("a\0b ä");
  writer.put_text("");
  writer.put_vector(std::vector<double>{1, -2, 3e300});
  writer.put_vector(std::vector<std::int32_t>{});
  const std::vector<std::byte> bytes = writer.take();
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::int32_t>(), -7);
  EXPECT_EQ(reader.get<double>(), 0.1);
  EXPECT_EQ(reader.get_text(), "a\0b ä");
  EXPECT_EQ(reader.get_text(), "");
  EXPECT_EQ(reader.get_vector<double>(), (std::vector<double>{1, -2, 3e300}));
  EXPECT_TRUE(reader.get_vector<std::int32_t>().empty());
  EXPECT_THROW(reader.get<std::uint8_t>(), InputError);
}

TEST(Bytes, counts_beyond_the_end_are_refused_before_memory_is_asked_for) {
  for (const std::uint64_t count :
       {std::uint64_t{3}, std::uint64_t{1} << 31, std::uint64_t{1} << 61,
        (std::uint64_t{1} << 61) + 2, ~std::uint64_t{0}}) {
    ByteWriter writer;
    writer.put(count);
    writer.put(1.0);
    writer.put(2.0);
    const std::vector<std::byte> bytes = writer.take();
    EXPECT_THROW(ByteReader(bytes).get_vector<double>(), InputError) << count;
    if (count > 16) {
      EXPECT_THROW(ByteReader(bytes).get_text(), InputError) << count;
    }
  }
}

TEST(Bytes, every_kind_of_mesh_comes_back_equal) {
  for (NamedMesh& named : all_meshes()) {
    Mesh& mesh = named.mesh;
    mesh.cut_facets[1] = 5;
    mesh.density_factor[0] = 0.75;
    mesh.region_name = {"liver", ""};
    mesh.element_region[1] = 1;
    EXPECT_TRUE(mesh_from_bytes(mesh_to_bytes(mesh)) == mesh) << named.name;
    mesh.hex_split_rank.assign(mesh.X.size(), 3);
    mesh.split_hexahedra = {{4, 7}, {1, 12}};
    mesh.node_sets.push_back({"outer", {0, 2, 3}, {{-1, 0, 2, 3}, {0, 1, 2, 3}}});
    mesh.fibre.assign(mesh.element_type.size(), Vec3(0.6, 0, 0.8));
    test::expect_equal(mesh_from_bytes(mesh_to_bytes(mesh)), mesh);
    mesh.hex_split_rank.pop_back();
    EXPECT_THROW(mesh_from_bytes(mesh_to_bytes(mesh)), InputError) << named.name;
  }
}

bool is_equal_edit(const MeshEdit& a, const MeshEdit& b) {
  const auto same_move = [](const NodeMove& m, const NodeMove& n) {
    return m.node == n.node && m.X == n.X && m.host == n.host && m.weight == n.weight;
  };
  const auto same_corner = [](const CornerChange& m, const CornerChange& n) {
    return m.element == n.element && m.corner == n.corner && m.node == n.node;
  };
  const auto same_facets = [](const CutFacets& m, const CutFacets& n) {
    return m.element == n.element && m.mask == n.mask;
  };
  const auto same_density = [](const DensityChange& m, const DensityChange& n) {
    return m.element == n.element && m.factor == n.factor;
  };
  const auto same = [](const auto& v, const auto& w, const auto& equal) {
    return std::equal(v.begin(), v.end(), w.begin(), w.end(), equal);
  };
  const auto same_node = [](const EdgeNode& m, const EdgeNode& n) {
    return m.end == n.end && m.s == n.s;
  };
  const auto same_split = [](const ElementSplit& m, const ElementSplit& n) {
    return m.element == n.element && m.n_tets == n.n_tets && m.corner == n.corner;
  };
  return same(a.inserted, b.inserted, same_node) && same(a.splits, b.splits, same_split) &&
         same(a.moves, b.moves, same_move) && a.duplicate_parent == b.duplicate_parent &&
         same(a.corners, b.corners, same_corner) && same(a.cut_facets, b.cut_facets, same_facets) &&
         same(a.density, b.density, same_density);
}

TEST(Bytes, an_edit_comes_back_equal) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 4, 3);
  EXPECT_TRUE(is_equal_edit(edit_from_bytes(edit_to_bytes({})), {}));
  MeshEdit edit = example_edit(mesh, 5);
  edit.moves.push_back({.node = 6, .X = Vec3(1, 2, 3), .host = 4, .weight = {0.1, 0.2, 0.7}});
  edit.density.push_back({.element = 7, .factor = 0.5});
  edit.inserted = {{.end = {3, 5}, .s = 0.3}, {.end = {3, 9}, .s = 0.6}};
  edit.splits = {{.element = 2, .n_tets = 2, .corner = {{{1, 2, 3, 4}, {5, 6, 7, 8}}}}};
  EXPECT_TRUE(is_equal_edit(edit_from_bytes(edit_to_bytes(edit)), edit));
}

// The same edit in memory that held `fill` before: what lies between the members differs.
template <class T>
std::vector<T> in_dirty_memory(T value, unsigned char fill) {
  std::vector<T> list(1);
  std::memset(static_cast<void*>(list.data()), fill, sizeof(T));
  list[0].element = value.element;
  if constexpr (requires { value.mask; }) list[0].mask = value.mask;
  if constexpr (requires { value.factor; }) list[0].factor = value.factor;
  return list;
}

TEST(Bytes, of_equal_edits_are_equal_whatever_memory_held_before) {
  MeshEdit clean, dirty;
  clean.cut_facets = in_dirty_memory(CutFacets{.element = 3, .mask = 5}, 0x00);
  dirty.cut_facets = in_dirty_memory(CutFacets{.element = 3, .mask = 5}, 0xff);
  clean.density = in_dirty_memory(DensityChange{.element = 4, .factor = 2}, 0x00);
  dirty.density = in_dirty_memory(DensityChange{.element = 4, .factor = 2}, 0xff);
  EXPECT_EQ(edit_to_bytes(clean), edit_to_bytes(dirty));
}

TEST(Bytes, cut_off_anywhere_are_refused) {
  const Mesh mesh = make_rectangle(0.07, 0.04, 3, 2);
  const std::vector<std::byte> mesh_bytes = mesh_to_bytes(mesh);
  const std::vector<std::byte> edit_bytes = edit_to_bytes(example_edit(mesh, 2));
  for (std::size_t n = 0; n < mesh_bytes.size(); ++n)
    EXPECT_THROW(mesh_from_bytes(std::span(mesh_bytes).first(n)), InputError) << n;
  for (std::size_t n = 0; n < edit_bytes.size(); ++n)
    EXPECT_THROW(edit_from_bytes(std::span(edit_bytes).first(n)), InputError) << n;
}

TEST(Bytes, of_moves_that_can_not_follow_are_refused_before_memory_is_asked_for) {
  std::vector<std::byte> bytes = edit_to_bytes({});  // seven counts, moves are the third
  bytes[2 * sizeof(std::uint64_t)] = std::byte{2};   // more than four counts fill
  EXPECT_TRUE(contains(error_of([&] { edit_from_bytes(bytes); }), "2 items announced"));
}

// No checksum protects these bytes (they may come from any program): whatever they say, the reader
// gives a mesh or refuses, and asks for no more memory than the bytes can fill.
TEST(Bytes, with_any_byte_changed_give_a_mesh_or_are_refused) {
  const std::vector<std::byte> mesh_bytes = mesh_to_bytes(make_rectangle(0.07, 0.04, 3, 2));
  int n_refused = 0;
  for (std::size_t n = 0; n < mesh_bytes.size(); ++n)
    for (const unsigned change : {0x01u, 0x80u, 0xffu}) {
      std::vector<std::byte> bytes = mesh_bytes;
      bytes[n] ^= static_cast<std::byte>(change);
      try {
        EXPECT_LE(mesh_from_bytes(bytes).X.size() * 3 * sizeof(double), bytes.size());
      } catch (const InputError&) {
        ++n_refused;
      }
    }
  EXPECT_GT(n_refused, 0);
}

TEST(Bytes, of_an_unknown_element_type_are_refused) {
  Mesh mesh = make_rectangle(0.07, 0.04, 3, 2);
  mesh.element_type[1] = static_cast<ElementType>(n_element_types);
  EXPECT_TRUE(contains(error_of([&] { mesh_from_bytes(mesh_to_bytes(mesh)); }), "unknown type 3"));
  mesh = make_rectangle(0.07, 0.04, 3, 2);
  for (const std::int32_t offset : {-1, 34, std::numeric_limits<std::int32_t>::max()}) {
    mesh.corner_offset.back() = offset;
    EXPECT_THROW(mesh_from_bytes(mesh_to_bytes(mesh)), InputError) << offset;
  }
}

TEST(Bytes, that_are_neither_yes_nor_no_are_refused) {
  const std::array<std::byte, 3> bytes = {std::byte{0}, std::byte{1}, std::byte{2}};
  ByteReader reader(bytes);
  EXPECT_FALSE(reader.get<bool>());
  EXPECT_TRUE(reader.get<bool>());
  EXPECT_THROW(reader.get<bool>(), InputError);
}

}  // namespace
}  // namespace trocar
