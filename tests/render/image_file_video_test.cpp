#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "base/error.h"
#include "error_of.h"
#include "render/image_file.h"
#include "render_scene.h"

using namespace trocar;
using namespace trocar::testing;

namespace {

Image grey_image(int width, int height, int level) {
  return {.width = width,
          .height = height,
          .rgb = std::vector<std::uint8_t>(std::size_t{3} * width * height,
                                           static_cast<std::uint8_t>(level))};
}

void write_film(const std::string& file, int width, int height, int n_frames) {
  VideoWriter film(file, width, height, 30);
  for (int k = 0; k < n_frames; ++k) film.add(grey_image(width, height, 10 * k % 256));
  film.finish();
}

// "width,height,number of frames" as ffprobe counts them.
std::string probe(const std::string& file) {
  const std::string command =
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=width,height,nb_read_frames "
      "-of csv=p=0 'file:" +
      file + "'";
  std::array<char, 100> line{};
  std::FILE* out = popen(command.c_str(), "r");
  if (!out) return "";
  if (!std::fgets(line.data(), line.size(), out)) line[0] = 0;
  pclose(out);
  std::string text = line.data();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

TEST(VideoWriter, film_holds_every_frame) {
  const TestFolder folder;
  write_film(folder.file("a.mp4"), 64, 48, 23);
  EXPECT_EQ(probe(folder.file("a.mp4")), "64,48,23");
  write_film(folder.file("a.mkv"), 64, 48, 23);
  EXPECT_EQ(probe(folder.file("a.mkv")), "64,48,23");
}

TEST(VideoWriter, odd_sizes_are_padded_to_even_ones) {
  const TestFolder folder;
  ::testing::internal::CaptureStderr();
  write_film(folder.file("odd.mp4"), 65, 47, 3);
  const std::string told = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("odd.mp4 has 66 x 48 pixels, not 65 x 47: films have even sizes"),
            std::string::npos)
      << told;
  EXPECT_EQ(probe(folder.file("odd.mp4")), "66,48,3");
}

TEST(VideoWriter, hostile_names_are_names) {
  const TestFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const std::string name :
       {"-i.mp4", "concat:a.mp4", "a;touch canary.mp4", "$(touch canary).mp4", "%d.mp4"}) {
    write_film(name, 16, 16, 2);
    EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
    EXPECT_EQ(probe(name).substr(0, 5), "16,16") << name;
  }
  EXPECT_FALSE(std::filesystem::exists("canary"));
  std::filesystem::current_path(before);
}

TEST(VideoWriter, missing_ffmpeg_is_an_error_that_names_the_package) {
  const TestFolder folder;
  const WithVariable path("PATH", folder.path());
  EXPECT_EQ(find_ffmpeg(), "");
  const auto film = [&] { VideoWriter(folder.file("a.mp4"), 16, 16, 30); };
  EXPECT_TRUE(contains(error_of<MachineError>(film), "install the package ffmpeg"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.mp4")));
}

TEST(VideoWriter, path_that_can_not_be_written_is_an_error_before_the_first_frame) {
  const TestFolder folder;
  EXPECT_THROW(VideoWriter("/no/such/folder/a.mp4", 16, 16, 30), MachineError);
  EXPECT_THROW(VideoWriter(folder.path(), 16, 16, 30), MachineError);
}

TEST(VideoWriter, encoder_that_dies_is_an_error_at_a_later_frame) {
  const TestFolder folder;
  std::filesystem::create_symlink("/bin/false", folder.file("ffmpeg"));
  const WithVariable path("PATH", folder.path());
  VideoWriter film(folder.file("a.mp4"), 320, 240, 30);
  const auto add_many = [&] {
    for (int k = 0; k < 50; ++k) film.add(grey_image(320, 240, 0));
  };
  EXPECT_THROW(add_many(), MachineError);
  EXPECT_THROW(film.finish(), MachineError);
}

TEST(VideoWriter, impossible_sizes_and_rates_are_refused) {
  const TestFolder folder;
  EXPECT_THROW(VideoWriter(folder.file("a.mp4"), 0, 16, 30), InputError);
  EXPECT_THROW(VideoWriter(folder.file("a.mp4"), 16, 16, 0), InputError);
  EXPECT_THROW(VideoWriter("", 16, 16, 30), InputError);
}

TEST(VideoWriter, endings_of_other_films_are_refused) {
  const TestFolder folder;
  for (const char* name : {"a.avi", "a.gif", "a.webm", "a.mp4.png"})
    EXPECT_THROW(VideoWriter(folder.file(name), 16, 16, 30), InputError) << name;
  EXPECT_EQ(film_name_fault("a.MP4"), "");
}

TEST(VideoWriter, film_that_is_dropped_without_finish_is_readable) {
  const TestFolder folder;
  {
    VideoWriter film(folder.file("a.mp4"), 32, 32, 30);
    for (int k = 0; k < 5; ++k) film.add(grey_image(32, 32, k));
  }
  EXPECT_EQ(probe(folder.file("a.mp4")), "32,32,5");
}
