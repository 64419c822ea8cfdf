// PNG files: libpng at its fastest useful setting (level 1, filter SUB), complete or not there at
// all.
#include <png.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/check.h"
#include "base/error.h"
#include "render/image_file.h"

namespace trocar {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

MachineError png_error_for(const std::string& file, const std::string& reason) {
  return MachineError("can't write the picture " + file + ": " + reason);
}

void keep_message(png_structp png, png_const_charp message) {
  std::snprintf(static_cast<char*>(png_get_error_ptr(png)), 200, "%s", message);
  png_longjmp(png, 1);
}
void ignore_warning(png_structp, png_const_charp) {}

// False with a reason if libpng fails. It reports by longjmp, so nothing here has a destructor.
bool encode(const Image& image, std::FILE* out, char (&reason)[200]) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, reason, keep_message, ignore_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, out);
  png_set_compression_level(png, 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const std::size_t row_size = 3 * static_cast<std::size_t>(image.width);
  for (int row = 0; row < image.height; ++row)
    png_write_row(png, image.rgb.data() + static_cast<std::size_t>(row) * row_size);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

void write_png(const Image& image, const std::string& file) {
  CHECK(image.width > 0 && image.height > 0);
  CHECK_OP(image.rgb.size(), ==, std::size_t{3} * image.width * image.height);
  const std::string part = file + ".part";
  std::unique_ptr<std::FILE, CloseFile> out(std::fopen(part.c_str(), "wbe"));
  if (!out) throw png_error_for(file, std::strerror(errno));
  char reason[200] = "out of memory";
  errno = 0;
  bool is_written = encode(image, out.get(), reason);
  if (std::fclose(out.release()) != 0) is_written = false;
  if (is_written && std::rename(part.c_str(), file.c_str()) == 0) return;
  const std::string why = errno != 0 ? std::strerror(errno) : reason;
  unlink(part.c_str());
  throw png_error_for(file, why);
}

}  // namespace trocar
