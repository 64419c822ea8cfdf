#include "engine/checkpoint_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/descriptor.h"
#include "base/error.h"

namespace trocar {

namespace {

bool write_all(const Descriptor& file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = write(file.number(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) errno = EIO;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

// Returns the number of the error, 0 if there is none; n_bytes: that `put` has given.
int write_to_disk(const std::string& file, const std::function<void(const ByteSink&)>& put,
                  std::size_t& n_bytes) {
  const Descriptor stream(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
  int trouble = stream.number() >= 0 ? 0 : errno;
  put([&](std::span<const std::byte> bytes) {
    n_bytes += bytes.size();
    if (trouble == 0 && !write_all(stream, bytes)) trouble = errno;
  });
  if (trouble == 0 && fsync(stream.number()) != 0) trouble = errno;
  return trouble;
}

// A rename is on the disk once the folder is. Some file systems can't: then it comes a little
// later.
void sync_folder(const std::string& file) {
  const std::string parent = std::filesystem::path(file).parent_path().string();
  const Descriptor folder(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder.number() >= 0) fsync(folder.number());
}

}  // namespace

void replace_file(const std::string& file, const std::function<void(const ByteSink&)>& put) {
  const std::string fresh = file + ".new";
  std::size_t n_bytes = 0;
  int trouble = write_to_disk(fresh, put, n_bytes);
  if (trouble == 0 && std::rename(fresh.c_str(), file.c_str()) != 0) trouble = errno;
  if (trouble != 0) {
    unlink(fresh.c_str());
    throw MachineError(file + ": can't be written (" + std::strerror(trouble) + ", " +
                       std::to_string(n_bytes) + " bytes needed)");
  }
  sync_folder(file);
}

void remove_checkpoint(const std::string& folder) {
  const std::string file = folder + "/" + checkpoint_name;
  std::error_code trouble;
  std::filesystem::remove(file, trouble);
  std::filesystem::remove(file + ".new", trouble);
  if (std::filesystem::exists(file))
    throw MachineError(file + ": an old checkpoint that can't be removed");
}

}  // namespace trocar
