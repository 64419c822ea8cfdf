#include "engine/film_studio.h"

#include <gtest/gtest.h>

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
          .orders = {0}};
}

// It drew each frame of the run and kept nine: 39 s where the simulation took 0.7 s.
TEST(FilmStudio, draws_the_nine_pictures_of_a_contact_sheet_and_no_others) {
  const Mesh mesh = make_box(Vec3::Zero(), Vec3::Constant(0.02), {2, 2, 2}, BoxElements::hex8);
  const TestFolder folder;
  SceneCamera camera;
  camera.eye = Vec3(0.1, 0.1, 0.1);
  FilmStudio studio({{.kind = OutputKind::contact_sheet,
                      .file = folder.file("sheet.png"),
                      .camera = camera,
                      .width = 64,
                      .height = 48,
                      .n_frames = 40}},
                    {}, false, {});
  for (std::int64_t k = 1; k <= 40; ++k) studio.add(frame_of(mesh, k));
  studio.finish();
  EXPECT_EQ(studio.n_drawn(), 9);
  EXPECT_TRUE(std::filesystem::exists(folder.file("sheet.png")));
}

}  // namespace
}  // namespace trocar
