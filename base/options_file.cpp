// Opens without blocking, so that a FIFO or a terminal is refused instead of waited for.
#include "base/options_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/descriptor.h"
#include "base/error.h"

namespace trocar {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& sentence) {
  throw InputError({file, 0, 0}, sentence);
}

void check_regular(const std::string& file, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) fail(file, "is a directory, not a file");
  if (!S_ISREG(status.st_mode)) fail(file, "is not a regular file");
}

}  // namespace

std::string read_options_file(const std::string& file) {
  if (file.find('\0') != std::string::npos) fail(file.c_str(), "a file name can't hold a NUL byte");
  const Descriptor descriptor(file, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  struct stat status {};
  if (descriptor.number() < 0 || fstat(descriptor.number(), &status) != 0)
    fail(file, std::string("can't be opened: ").append(std::strerror(errno)));
  check_regular(file, status);
  std::string text;
  char buffer[65536];
  while (true) {
    const ssize_t n = read(descriptor.number(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, std::string("can't be read: ").append(std::strerror(errno)));
    if (n == 0) break;
    text.append(buffer, static_cast<std::size_t>(n));
    if (text.size() > max_options_bytes)
      fail(file, "is larger than 16 MB, the limit for such a file");
  }
  if (text.empty()) fail(file, "is empty");
  return text;
}

}  // namespace trocar
