// Pictures and films on disk. libpng is seen by image_file_png.cpp alone; films are made by the
// ffmpeg program.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace trocar {

// As write_whole_file does, with its MachineError.
void write_png(const Image& image, const std::string& file);

// What is wrong with the name of a film's file, whose ending players choose by; "" if nothing.
std::string film_name_fault(const std::string& file);

// Encodes frames as they come: raw RGB through a pipe to `ffmpeg` (posix_spawn with argv, no
// shell), in a thread of its own with a short queue. mp4 with fragments, so that the film of a
// killed run is readable. Throws MachineError if ffmpeg is missing (says which package) or fails
// (its last line).
class VideoWriter {
 public:
  VideoWriter(const std::string& file, int width, int height, double frame_rate);
  ~VideoWriter();
  void add(Image image);  // blocks while the queue is full
  void finish();          // waits for ffmpeg; call before the destructor to see errors

 private:
  struct Pipe;
  std::unique_ptr<Pipe> pipe_;
};

// `columns` x rows of pictures scaled down to `tile_width`, with a caption each.
struct ContactSheet {
  std::vector<Image> images;
  std::vector<std::string> captions;
  int columns = 3;
  int tile_width = 640;
};
Image draw_contact_sheet(const ContactSheet& sheet);

// The ffmpeg that would be used, "" if there is none in PATH. For `trocar doctor`.
std::string find_ffmpeg();

}  // namespace trocar
