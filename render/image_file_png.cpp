// PNG files: libpng at its fastest useful setting (level 1, filter SUB), into memory first, so that
// a file is complete or not there at all.
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#include "base/check.h"
#include "base/error.h"
#include "base/whole_file.h"
#include "render/image_file.h"

namespace trocar {

namespace {

struct FreeBytes {
  void operator()(char* bytes) const { std::free(bytes); }
};

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
  char* bytes = nullptr;
  std::size_t n_bytes = 0;
  char reason[200] = "out of memory";
  std::FILE* const out = open_memstream(&bytes, &n_bytes);
  bool is_encoded = out != nullptr && encode(image, out, reason);
  if (out != nullptr && std::fclose(out) != 0) is_encoded = false;
  const std::unique_ptr<char, FreeBytes> owner(bytes);
  if (!is_encoded) throw MachineError(file + ": can't be written: " + reason);
  write_whole_file(file, {bytes, n_bytes});
}

}  // namespace trocar
