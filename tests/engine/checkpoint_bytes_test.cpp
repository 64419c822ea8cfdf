#include <gtest/gtest.h>

#include "base/digest.h"
#include "engine/archive.h"
#include "engine/bytes.h"
#include "engine/checkpoint.h"
#include "engine_checkpoint.h"
#include "engine_checkpoint_members.h"
#include "engine_recording.h"
#include "error_of.h"

namespace trocar {
namespace {

TEST(CheckpointBytes, read_back_give_the_same_checkpoint) {
  const Checkpoint c = example_checkpoint();
  const Checkpoint back = checkpoint_from_bytes(checkpoint_to_bytes(c), "c");
  EXPECT_EQ(back.scene, c.scene);
  EXPECT_EQ(back.frame, 17);
  EXPECT_EQ(back.digest, 99u);
  EXPECT_TRUE(*back.mesh == *c.mesh);
  EXPECT_EQ(back.fixed, c.fixed);
  EXPECT_EQ(back.u, c.u);
  EXPECT_EQ(back.v, c.v);
  EXPECT_EQ(back.holds.at(0).offset, Vec3(1, 2, 3));
  EXPECT_TRUE(back.cuts.at(0).stroke.hit.at(0).is_first_plus);
  EXPECT_EQ(back.cuts[0].stroke.hit[0].X, Vec3(4, 5, 6));
  EXPECT_EQ(back.cuts[0].stroke.step.at(0).value, 0.25);
  EXPECT_TRUE(back.cuts[0].is_engaged);
  EXPECT_EQ(back.cuts[0].strokes.at(0).tool, "scalpel");
  EXPECT_EQ(back.cuts[0].strokes[0].n_edits, 4);
  EXPECT_EQ(back.rows->at(1).tools.at(0).position, Vec3(7, 8, 1));
  EXPECT_EQ(back.tally.events, c.tally.events);
  EXPECT_EQ(back.outputs.at(0).last_frame, 16);
  EXPECT_EQ(edit_to_bytes(back.outputs[0].pending.at(0)), edit_to_bytes(c.outputs[0].pending[0]));
}

// Changes every number, text, list and mesh in it, also in members of members, one at a time.
struct EachChange {
  Checkpoint& checkpoint;
  std::string place = "";  // of the member, positions from 0 on
  int n = 0;

  void in(Vec3& v) { in_each(std::tie(v[0], v[1], v[2])); }
  void in(std::string& text) { tell(text, text + "!"); }
  void in(MeshEdit& edit) { tell(edit, example_edit(*checkpoint.mesh, 3)); }
  void in(std::shared_ptr<const Mesh>& mesh) {
    tell(mesh, std::make_shared<const Mesh>(make_rectangle(0.02, 0.01, 2, 3)));
  }
  void in(std::shared_ptr<const std::vector<FrameRow>>& rows) {
    const auto own = std::make_shared<std::vector<FrameRow>>(*rows);
    rows = own;
    in(*own);
  }
  template <class T>
  void in(std::vector<T>& values) {
    std::vector<T> more = values;
    more.emplace_back();
    if (values.empty()) values = more;
    tell(values, std::vector<T>(values.size() + 1, values[0]));
    in(values[0]);
  }
  template <class T>
  void in(T& value) {
    if constexpr (std::is_same_v<T, bool>)
      tell(value, !value);
    else if constexpr (std::is_enum_v<T>)
      tell(value, static_cast<T>(static_cast<int>(value) + 1));
    else if constexpr (is_plain<T>)
      tell(value, static_cast<T>(value + 1));
    else
      in_each(members(value));
  }
  template <class... T>
  void in_each(const std::tuple<T&...>& values) {
    const std::string before = place;
    int k = 0;
    const auto one = [&](auto& value) {
      place = before + " " + std::to_string(k++);
      in(value);
    };
    std::apply([&](auto&... value) { (one(value), ...); }, values);
    place = before;
  }
  template <class T>
  void tell(T& value, T other) {
    const std::vector<std::byte> before = checkpoint_to_bytes(checkpoint);
    std::swap(value, other);
    const std::vector<std::byte> after = checkpoint_to_bytes(checkpoint);
    EXPECT_FALSE(after == before) << "member" << place;
    EXPECT_TRUE(checkpoint_to_bytes(checkpoint_from_bytes(after, "c")) == after)
        << "member" << place;
    std::swap(value, other);
    ++n;
  }
};

TEST(CheckpointBytes, have_every_member_and_give_it_back) {
  Checkpoint c = example_checkpoint();
  EachChange change{.checkpoint = c};
  change.in(c);
  EXPECT_GT(change.n, 250);
}

// Of a mesh and of fields that don't fit into a piece.
TEST(CheckpointBytes, of_a_large_body_are_handed_on_in_small_pieces) {
  Checkpoint c = example_checkpoint();
  c.mesh =
      std::make_shared<const Mesh>(make_box({0, 0, 0}, {1, 1, 1}, {33, 33, 33}, BoxElements::hex8));
  const std::size_t n = 3 * c.mesh->X.size();
  for (std::size_t k = 0; k < n; ++k) c.looked_at.push_back(std::sin(static_cast<double>(k)));
  c.u.assign(c.looked_at.rbegin(), c.looked_at.rend());
  c.v = c.looked_at;
  ASSERT_GT(n_bytes_of(*c.mesh), 2 * ByteWriter::piece_size);
  ASSERT_GT(2 * n * sizeof(double), ByteWriter::piece_size);
  std::vector<std::byte> bytes;
  int n_pieces = 0;
  PackedRows packed;
  put_checkpoint(c, packed, [&](std::span<const std::byte> piece) {
    EXPECT_LT(piece.size(), ByteWriter::piece_size + 1000);
    ++n_pieces;
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  });
  EXPECT_GT(n_pieces, 6);
  const Checkpoint back = checkpoint_from_bytes(bytes, "c");
  EXPECT_TRUE(*back.mesh == *c.mesh);
  EXPECT_EQ(back.u, c.u);
  EXPECT_EQ(back.v, c.v);
  EXPECT_EQ(back.looked_at, c.looked_at);
}

// The last row's latency is not known when it is written first.
TEST(CheckpointBytes, of_a_long_run_keep_all_rows_and_pack_each_once) {
  Checkpoint c = example_checkpoint();
  PackedRows packed;
  std::ptrdiff_t n_packed = 0;
  for (const int n_rows : {0, 1, 256, 257, 500, 513, 5000}) {
    auto rows = rows_of(n_rows);
    c.rows = rows;
    for (const double latency : {-1.0, 3.0}) {
      if (n_rows > 0) rows->back().latency = latency;
      std::vector<std::byte> bytes;
      put_checkpoint(c, packed, [&](std::span<const std::byte> more) {
        bytes.insert(bytes.end(), more.begin(), more.end());
      });
      EXPECT_EQ(bytes, checkpoint_to_bytes(c));
      const Checkpoint back = checkpoint_from_bytes(bytes, "c");
      ASSERT_EQ(back.rows->size(), rows->size());
      for (std::size_t k = 0; k < rows->size(); ++k) {
        EXPECT_EQ(back.rows->at(k).tools.at(0).position.z(), k);
        EXPECT_EQ(back.rows->at(k).latency, rows->at(k).latency);
      }
    }
    EXPECT_LT(packed.n, std::max(n_rows, 1));
    EXPECT_GE(packed.n, n_rows - 256);
    EXPECT_GE(packed.n, n_packed);
    n_packed = packed.n;
  }
}

TEST(CheckpointBytes, have_the_numbers_of_refusals_that_older_ones_have) {
  EXPECT_EQ(CutRefusal::pinched, 0);
  EXPECT_EQ(CutRefusal::chip, 1);
  EXPECT_EQ(CutRefusal::missed, 2);
  EXPECT_EQ(CutRefusal::bent, 3);
  EXPECT_EQ(CutRefusal::slice_held, 7);
  EXPECT_EQ(CutRefusal::slice, 8);
  EXPECT_EQ(CutRefusal::crushed, 9);
}

TEST(CheckpointBytes, with_any_byte_changed_are_refused) {
  const std::vector<std::byte> good = checkpoint_to_bytes(example_checkpoint());
  for (std::size_t k = 0; k < good.size(); ++k)
    for (const int change : {1, 128, 255}) {
      std::vector<std::byte> bad = good;
      bad[k] ^= static_cast<std::byte>(change);
      EXPECT_THROW(checkpoint_from_bytes(bad, "c"), InputError) << "byte " << k << " ^ " << change;
    }
}

TEST(CheckpointBytes, cut_off_anywhere_are_refused) {
  const std::vector<std::byte> good = checkpoint_to_bytes(example_checkpoint());
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(checkpoint_from_bytes(std::span(good).first(n), "c"), InputError) << n << " bytes";
}

TEST(CheckpointBytes, that_are_damaged_say_so_and_how_to_go_on) {
  std::vector<std::byte> bytes = checkpoint_to_bytes(example_checkpoint());
  bytes[40] ^= std::byte{1};
  EXPECT_EQ(error_of([&] { checkpoint_from_bytes(bytes, "out/checkpoint.bin"); }),
            "out/checkpoint.bin: damaged (its checksum does not match); start without --resume");
}

TEST(CheckpointBytes, of_another_format_are_named_as_such) {
  std::vector<std::byte> bytes = checkpoint_to_bytes(example_checkpoint());
  bytes[8] = std::byte{99};  // behind the mark of eight bytes
  const std::uint32_t crc = crc32c(std::span(bytes).first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &crc, 4);
  EXPECT_TRUE(contains(error_of([&] { checkpoint_from_bytes(bytes, "c"); }), "format 99"));
}

}  // namespace
}  // namespace trocar
