#include <gtest/gtest.h>
#include <png.h>

#include <fstream>

#include "base/error.h"
#include "error_of.h"
#include "render/image_file.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

Image numbered_image(int width, int height) {
  Image image{.width = width, .height = height};
  for (int k = 0; k < width * height * 3; ++k)
    image.rgb.push_back(static_cast<std::uint8_t>(k * 37 + k / 256));
  return image;
}

Image read_png(const std::string& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image image;
  if (!png_image_begin_read_from_file(&png, file.c_str())) return image;
  png.format = PNG_FORMAT_RGB;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr);
  return image;
}

}  // namespace

TEST(ImageFile, png_reads_back_as_the_same_pixels) {
  const TestFolder folder;
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{33, 7}, std::pair{640, 360}}) {
    const Image image = numbered_image(w, h);
    write_png(image, folder.file("a.png"));
    const Image back = read_png(folder.file("a.png"));
    EXPECT_EQ(back.width, w);
    EXPECT_EQ(back.rgb, image.rgb);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.png.part")));
}

TEST(ImageFile, png_that_can_not_be_written_is_an_error_with_path_and_reason) {
  const TestFolder folder;
  for (const std::string& file : {folder.file("no/such/folder.png"), folder.path()}) {
    const auto write = [&] { write_png(numbered_image(4, 4), file); };
    EXPECT_TRUE(contains(error_of<MachineError>(write), file + ": ")) << file;
    EXPECT_FALSE(std::filesystem::exists(file + ".part"));
  }
}

TEST(ImageFile, png_goes_where_a_link_of_its_name_leads) {
  const TestFolder folder;
  const Image image = numbered_image(8, 8);
  std::filesystem::create_symlink(folder.file("far.png"), folder.file("near.png"));
  write_png(image, folder.file("near.png"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("near.png")));
  EXPECT_EQ(read_png(folder.file("far.png")).rgb, image.rgb);
}

TEST(ImageFile, full_disk_leaves_the_old_picture) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this machine";
  const TestFolder folder;
  const std::string file = folder.file("a.png");
  const Image first = numbered_image(8, 8);
  write_png(first, file);
  std::filesystem::create_symlink("/dev/full", file + ".part");
  EXPECT_THROW(write_png(numbered_image(64, 64), file), MachineError);
  EXPECT_EQ(read_png(file).rgb, first.rgb);
}
