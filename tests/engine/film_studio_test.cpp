#include "engine/film_studio.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "engine/output.h"
#include "mesh/generate.h"
#include "test_files.h"

namespace trocar {
namespace {

FilmFrame frame_of(const Mesh& mesh, std::int64_t number) {
  return {.number = number,
          .time = 0.1 * static_cast<double>(number),
          .x = mesh.X,
          .X = mesh.X,
          .surface = boundary_surface(mesh),
          .region = surface_regions(mesh, boundary_surface(mesh)),
          .orders = {0}};
}

std::int64_t n_drawn_of(std::vector<FilmOrder> orders, const Mesh& mesh, std::int64_t first) {
  std::vector<OutputSlot> slots;
  for (FilmOrder& order : orders) {
    order.camera.eye = Vec3(0.1, 0.1, 0.1);
    order.width = 64;
    order.height = 48;
    slots.push_back({.kind = order.kind, .n_frames = 40});
  }
  FilmStudio studio(std::move(orders), {}, mesh, {});
  for (std::int64_t k = first + 1; k <= 40; ++k) {
    FilmFrame frame = frame_of(mesh, k);
    frame.orders.clear();
    for (std::size_t order = 0; order < slots.size(); ++order)
      if (slots[order].is_due(k)) frame.orders.push_back(order);
    studio.add(std::move(frame));
  }
  studio.finish();
  return studio.n_drawn();
}

// It drew each frame of the run and kept nine: 39 s where the simulation took 0.7 s.
TEST(FilmStudio, draws_the_nine_pictures_of_a_contact_sheet_and_no_others) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {2, 2, 2}, BoxElements::hex8);
  const TestFolder folder;
  const FilmOrder sheet{.kind = OutputKind::contact_sheet, .file = folder.file("sheet.png")},
      frames{.kind = OutputKind::frames, .file = folder.file("frames")};
  EXPECT_EQ(n_drawn_of({sheet}, mesh, 0), 9);
  EXPECT_TRUE(std::filesystem::exists(sheet.file));
  // Moments are 4, 8, 13, 17, 22, 26, 31, 35 and 40: the last five of a run that goes on at 20.
  EXPECT_EQ(n_drawn_of({sheet}, mesh, 20), 5);
  EXPECT_EQ(n_drawn_of({sheet, frames}, mesh, 0), 40);  // one picture for both
}

TEST(FilmStudio, says_at_once_that_a_film_can_not_be_opened) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {1, 1, 1}, BoxElements::hex8);
  const TestFolder folder;
  const FilmOrder frames{.kind = OutputKind::frames, .file = folder.file("file", "") + "/frames"};
  EXPECT_ANY_THROW(FilmStudio({frames}, {}, mesh, {}));
}

FilmOrder small_frames(const TestFolder& folder) {
  FilmOrder frames{.kind = OutputKind::frames, .file = folder.file("frames")};
  frames.camera.eye = Vec3(0.1, 0.1, 0.1);
  frames.width = 64;
  frames.height = 48;
  return frames;
}

TEST(FilmStudio, has_written_all_pictures_when_it_is_finished) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {1, 1, 1}, BoxElements::hex8);
  const TestFolder folder;
  FilmStudio studio({small_frames(folder)}, {}, mesh, {});
  for (int k = 0; k < 20; ++k) studio.add(frame_of(mesh, k));
  studio.finish();
  for (int k = 0; k < 20; ++k)
    EXPECT_FALSE(
        read_text(folder.file("frames/0000") + (k < 10 ? "0" : "") + std::to_string(k) + ".png")
            .empty())
        << k;
}

TEST(FilmStudio, tells_that_a_picture_can_not_be_written) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {1, 1, 1}, BoxElements::hex8);
  const TestFolder folder;
  const FilmOrder order = small_frames(folder);
  std::filesystem::create_directories(order.file + "/000001.png");
  const auto add_one = [&] {
    FilmStudio studio({order}, {}, mesh, {});
    studio.add(frame_of(mesh, 1));
    studio.finish();
  };
  EXPECT_THROW(add_one(), MachineError);
  const auto add_many = [&] {
    FilmStudio studio({order}, {}, mesh, {});
    for (int k = 0; k < 100; ++k) studio.add(frame_of(mesh, 1));
  };
  EXPECT_THROW(add_many(), MachineError);
}

TEST(FilmStudio, that_nobody_finishes_writes_what_it_has) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {1, 1, 1}, BoxElements::hex8);
  const TestFolder folder;
  FilmOrder sheet = small_frames(folder);
  sheet.kind = OutputKind::contact_sheet;
  sheet.file = folder.file("sheet.png");
  FilmStudio({sheet}, {}, mesh, {}).add(frame_of(mesh, 1));
  EXPECT_TRUE(std::filesystem::exists(sheet.file));
}

// Of a box with a tumour in a corner, which has a look of its own.
TEST(FilmStudio, draws_regions_in_their_colours) {
  Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {2, 2, 2}, BoxElements::hex8);
  mesh.region_name.push_back("tumour");
  mesh.element_region[0] = 1;
  SceneTissue tissue;
  const auto bytes_with = [&](const SceneTissue& of) {
    const TestFolder folder;
    FilmOrder order{.kind = OutputKind::frames, .file = folder.file("frames")};
    order.camera.eye = Vec3(-0.03, -0.03, -0.03);
    FilmStudio studio({order}, of, mesh, {});
    studio.add(frame_of(mesh, 1));
    studio.finish();
    return read_text(order.file + "/000001.png");
  };
  const std::string plain = bytes_with(tissue);
  tissue.region_materials.push_back({.region = "tumour"});
  EXPECT_EQ(bytes_with(tissue), plain);
  tissue.region_materials.back().look = {.colour = {0.6, 0.6, 0.3}};
  EXPECT_NE(bytes_with(tissue), plain);
  mesh.element_region[0] = 0;
  EXPECT_EQ(bytes_with(tissue), plain);
}

}  // namespace
}  // namespace trocar
