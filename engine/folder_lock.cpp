#include "engine/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/host.h"
#include "base/log.h"
#include "engine/run_files.h"

namespace trocar {

namespace {

int open_lock(const std::string& file) {
  return open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
}

// Whether the open file is still the one of this name: a run that ends removes it.
bool is_at(const std::string& file, int number) {
  struct stat mine {
  }, there{};
  return fstat(number, &mine) == 0 && stat(file.c_str(), &there) == 0 &&
         mine.st_dev == there.st_dev && mine.st_ino == there.st_ino;
}

// "process 1234 on HOST", by whom it holds; "" if that is not known.
std::string holder(int number) {
  std::array<char, 300> text{};
  return pread(number, text.data(), text.size() - 1, 0) > 0 ? text.data() : "";
}

// Where the disk is too full for the room, or its file system can't reserve any, there is none.
void write_holder(int number) {
  constexpr off_t room = 1 << 16;  // [bytes]
  if (ftruncate(number, 0) == 0)
    dprintf(number, "process %d on %s", static_cast<int>(getpid()), host_name().c_str());
  fallocate(number, FALLOC_FL_KEEP_SIZE, 0, room);
}

[[noreturn]] void refuse(const std::string& folder, int number) {
  const std::string other = holder(number);
  close(number);
  throw InputError("the output folder \"" + folder + "\" is in use by another run" +
                   (other.empty() ? "" : " (" + other + ")") +
                   ": choose another one with -o, or wait until that run has ended");
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : file_(folder + "/" + lock_name) {
  constexpr int enough_tries = 100;  // each in vain only if a run ends just then
  for (int tries = 0; tries < enough_tries; ++tries) {
    if (number_ >= 0) close(number_);
    number_ = open_lock(file_);
    if (number_ < 0) return;
    if (flock(number_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) refuse(folder, number_);
      log_warning(file_ + " can't be locked (" + std::strerror(errno) +
                  "): nothing keeps another run out of this folder");
      close(std::exchange(number_, -1));
      return;
    }
    if (!is_at(file_, number_)) continue;
    write_holder(number_);
    return;
  }
}

FolderLock::~FolderLock() {
  if (number_ < 0) return;
  unlink(file_.c_str());
  close(number_);
}

void FolderLock::give_up_room() {
  if (number_ < 0 || ftruncate(number_, 0) == 0) return;
  log_warning(file_ + ": the room that it keeps for the summary can't be freed");
}

}  // namespace trocar
