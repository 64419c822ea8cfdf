// Reading and writing of whole files.
#include "base/whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

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

}  // namespace

// A directory, pipe or device is refused before it is opened.
std::string fault_of_file(const std::string& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    return file + ": there is no file of this name";
  if (error) return file + ": can't be read: " + error.message();
  if (std::filesystem::is_directory(status)) return file + ": is a directory, not a file";
  if (!std::filesystem::is_regular_file(status))
    return file + ": is not a regular file (a pipe or a device can't be read)";
  return "";
}

std::string read_whole_file(const std::string& file) {
  const std::string fault = fault_of_file(file);
  if (!fault.empty()) throw InputError(fault);
  const Stream stream(std::fopen(file.c_str(), "rb"));
  if (!stream) throw InputError(file + ": can't be opened: " + std::strerror(errno));
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) throw InputError(file + ": can't be read: " + error.message());
  if (size == 0) throw InputError(file + ": is empty");
  std::string content(size, '\0');
  const std::size_t n = std::fread(content.data(), 1, content.size(), stream.get());
  if (std::ferror(stream.get()) != 0)
    throw MachineError(file + ": reading failed: " + std::strerror(errno));
  content.resize(n);
  return content;
}

void write_whole_file(const std::string& file, std::string_view content) {
  std::error_code ignored;  // opening tells
  const bool is_link = std::filesystem::is_symlink(file, ignored);
  const std::string linked = is_link ? std::filesystem::canonical(file, ignored).string() : "";
  const std::string target = linked.empty() ? file : linked;
  const bool is_replaced = !std::filesystem::is_other(file, ignored);  // no device, no pipe
  const std::string part = is_replaced ? target + ".part" : file;
  Stream stream(std::fopen(part.c_str(), "wb"));
  if (!stream) fail_write(file, part);
  const bool is_written =
      std::fwrite(content.data(), 1, content.size(), stream.get()) == content.size();
  // fclose flushes: a full disk may show only there.
  if (!is_written || std::fflush(stream.get()) != 0) fail_write(file, part);
  if (std::fclose(stream.release()) != 0) fail_write(file, part);
  if (is_replaced && std::rename(part.c_str(), target.c_str()) != 0) fail_write(file, part);
}

}  // namespace trocar
