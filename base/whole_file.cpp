// Reading and writing of whole files.
#include "base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/descriptor.h"
#include "base/error.h"

namespace trocar {

namespace {

struct CloseFile {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};
using Stream = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail_write(const std::string& file, const std::string& part) {
  const std::string reason = std::strerror(errno);
  if (part != file) std::remove(part.c_str());
  throw MachineError(file + ": can't be written: " + reason);
}

std::string fault_of_name(const std::string& file) {
  if (file.find('\0') == std::string::npos) return "";
  return std::string(file.c_str()) + ": a file name can't hold a NUL byte";
}

// As errno tells.
std::string fault_to_open(const std::string& file) {
  if (errno == ENOENT || errno == ENOTDIR) return file + ": there is no file of this name";
  return file + ": can't be opened: " + std::strerror(errno);
}

std::string fault_of_kind(const std::string& file, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return file + ": is a directory, not a file";
  if (!S_ISREG(status.st_mode))
    return file + ": is not a regular file (a pipe or a device can't be read)";
  return "";
}

void refuse_if(const std::string& fault) {
  if (!fault.empty()) throw InputError(fault);
}

void check_size(const std::string& file, std::size_t size, std::size_t most_bytes) {
  if (size > most_bytes)
    throw InputError(file + ": is larger than " + std::to_string(most_bytes >> 20) +
                     " MB, the limit for such a file");
}

// Into content from `at` on, which is below its end; returns how many bytes, 0 at the file's end.
std::size_t read_some(const std::string& file, const Descriptor& descriptor, std::string& content,
                      std::size_t at) {
  ssize_t n = -1;
  do n = read(descriptor.number(), content.data() + at, content.size() - at);
  while (n < 0 && errno == EINTR);
  if (n < 0) throw MachineError(file + ": reading failed: " + std::strerror(errno));
  return static_cast<std::size_t>(n);
}

}  // namespace

std::string fault_of_file(const std::string& file) {
  const std::string fault = fault_of_name(file);
  if (!fault.empty()) return fault;
  struct stat status {};
  return stat(file.c_str(), &status) != 0 ? fault_to_open(file) : fault_of_kind(file, status);
}

std::string read_whole_file(const std::string& file, std::size_t most_bytes) {
  refuse_if(fault_of_name(file));
  // Without blocking: a pipe or a terminal is refused instead of waited for.
  const Descriptor descriptor(file, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  struct stat status {};
  const bool is_open = descriptor.number() >= 0 && fstat(descriptor.number(), &status) == 0;
  refuse_if(is_open ? fault_of_kind(file, status) : fault_to_open(file));
  const auto size = static_cast<std::size_t>(status.st_size);
  check_size(file, size, most_bytes);
  std::string content(size + 1, '\0');  // the end is met without growing
  std::size_t n = 0;
  while (const std::size_t n_read = read_some(file, descriptor, content, n)) {
    n += n_read;
    check_size(file, n, most_bytes);
    if (n == content.size()) content.resize(2 * n);
  }
  if (n == 0) throw InputError(file + ": is empty");
  content.resize(n);
  return content;
}

// Of a link that leads to no file yet, too.
static std::filesystem::path end_of_links(std::filesystem::path file) {
  constexpr int most_links = 40;  // as the system allows
  std::error_code ignored;
  for (int k = 0; k < most_links && std::filesystem::is_symlink(file, ignored); ++k)
    file = file.parent_path() / std::filesystem::read_symlink(file, ignored);
  return file;
}

void write_whole_file(const std::string& file, std::string_view content) {
  std::error_code ignored;  // opening tells
  const std::string target = end_of_links(file).string();
  const bool is_replaced = !std::filesystem::is_other(file, ignored);  // no device, no pipe
  const std::string part = is_replaced ? target + ".part" : file;
  Stream stream(std::fopen(part.c_str(), "wbe"));
  if (!stream) fail_write(file, part);
  const bool is_written =
      std::fwrite(content.data(), 1, content.size(), stream.get()) == content.size();
  // fclose flushes: a full disk may show only there.
  if (!is_written || std::fflush(stream.get()) != 0) fail_write(file, part);
  if (std::fclose(stream.release()) != 0) fail_write(file, part);
  if (is_replaced && std::rename(part.c_str(), target.c_str()) != 0) fail_write(file, part);
}

}  // namespace trocar
