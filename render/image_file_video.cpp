// Films: raw frames to the ffmpeg program.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/check.h"
#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/quoted.h"
#include "render/encoder_process.h"
#include "render/image_file.h"
#include "render/work_queue.h"

namespace trocar {

namespace {

constexpr std::size_t frames_in_flight = 4;

bool is_program(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode) && access(path.c_str(), X_OK) == 0;
}

std::string needed_ffmpeg() {
  const std::string path = find_ffmpeg();
  if (path.empty())
    throw MachineError(
        "a film needs the program ffmpeg, which is not in PATH; install the package ffmpeg");
  return path;
}

// ffmpeg writes to the path itself whatever its name looks like ("-x", "concat:a").
std::string literal_path(const std::string& file) {
  return "file:" + file;
}

std::string ending_of(const std::string& file) {
  return in_small_letters(std::filesystem::path(file).extension().string());
}

// The error comes before the first frame. Leaves an empty file, as the encoder would.
void check_writable(const std::string& file) {
  const int f = open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
  if (f < 0) throw MachineError("can't write the film " + file + ": " + std::strerror(errno));
  close(f);
}

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// The encoder's filter pads them.
void warn_of_odd_size(const std::string& file, int width, int height) {
  if (width % 2 == 0 && height % 2 == 0) return;
  log_warning("the film " + file + " has " + size_text(width + width % 2, height + height % 2) +
              " pixels, not " + size_text(width, height) + ": films have even sizes");
}

std::vector<std::string> encoder_arguments(const std::string& file, int width, int height,
                                           double frame_rate) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  const bool is_matroska = ending_of(file) == ".mkv";
  // A key frame a second: a fragment is written with each.
  const std::string key_frames = std::to_string(std::max(1L, std::lround(frame_rate)));
  // Players take high-definition colours for BT.709 whatever a film says; 4:2:0 needs even sizes.
  std::vector<std::string> argv = {
      needed_ffmpeg(),
      "-hide_banner",
      "-nostats",
      "-loglevel",
      "error",
      "-y",
      "-f",
      "rawvideo",
      "-pix_fmt",
      "rgb24",
      "-s",
      size,
      "-r",
      short_text(frame_rate, 10),
      "-i",
      "pipe:0",
      "-vf",
      "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
      "-an",
      "-c:v",
      "libx264",
      "-preset",
      "veryfast",
      "-crf",
      "18",
      "-pix_fmt",
      "yuv420p",
      "-g",
      key_frames,
      "-colorspace",
      "bt709",
      "-color_primaries",
      "bt709",
      "-color_trc",
      "bt709"};
  const std::vector<std::string> container =
      is_matroska ? std::vector<std::string>{"-f", "matroska"}
                  : std::vector<std::string>{
                        "-movflags", "frag_keyframe+empty_moov+default_base_moof", "-f", "mp4"};
  argv.insert(argv.end(), container.begin(), container.end());
  argv.push_back(literal_path(file));
  return argv;
}

}  // namespace

std::string find_ffmpeg() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = (folder.empty() ? "." : folder) + "/ffmpeg";
    if (is_program(candidate)) return candidate;
  }
  return "";
}

std::string film_name_fault(const std::string& file) {
  if (file.empty()) return "a film needs a file name";
  const std::string ending = ending_of(file);
  for (const char* known : {"", ".mp4", ".m4v", ".mov", ".mkv"})
    if (ending == known) return "";
  return "\"" + file + "\" can't be a " + ending +
         ": films are written as .mp4, .m4v, .mov or .mkv";
}

struct VideoWriter::Pipe {
  std::string file;
  int width, height;
  EncoderProcess encoder;
  WorkQueue<Image> work;

  Pipe(const std::string& path, int w, int h, double rate)
      : file(path),
        width(w),
        height(h),
        encoder(encoder_arguments(path, w, h, rate)),
        work(frames_in_flight,
             [this](Image& image) { with_file_name([&] { encoder.write(image.rgb); }); }) {}

  template <class Body>
  void with_file_name(const Body& body) const {
    try {
      body();
    } catch (const MachineError& error) {
      throw MachineError("can't write the film " + file + ": " + error.what());
    }
  }
};

VideoWriter::VideoWriter(const std::string& file, int width, int height, double frame_rate) {
  if (width < 1 || height < 1)
    throw InputError("a film needs pictures of at least 1 x 1 pixels, not " +
                     size_text(width, height));
  if (!(frame_rate > 0 && frame_rate <= 1e6))
    throw InputError("a film's frame rate must be above 0 and at most 1e6 Hz, not " +
                     short_text(frame_rate, 10));
  if (const std::string fault = film_name_fault(file); !fault.empty()) throw InputError(fault);
  needed_ffmpeg();
  check_writable(file);
  warn_of_odd_size(file, width, height);
  pipe_ = std::make_unique<Pipe>(file, width, height, frame_rate);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(Image image) {
  CHECK_OP(image.width, ==, pipe_->width);
  CHECK_OP(image.height, ==, pipe_->height);
  pipe_->work.add(std::move(image));
}

void VideoWriter::finish() {
  pipe_->work.finish();
  pipe_->with_file_name([&] { pipe_->encoder.finish(); });
}

}  // namespace trocar
