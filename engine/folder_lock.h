// A run's claim on its output folder: two runs in one folder would mix their files, and one that
// fills the disk would not be able to say so in its summary.
#pragma once

#include <string>

namespace trocar {

// Holds an advisory lock (flock) on `folder`/.trocar-lock, which the system releases when the
// process ends in whatever way, so that a file left behind by a killed run locks nothing. The file
// keeps room on the disk for a summary.
class FolderLock {
 public:
  // Throws InputError that names the other run if one holds the lock. Goes on without one where the
  // folder does not exist or its file system can't lock.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();  // removes the file
  void give_up_room();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::string file_;
  int number_ = -1;  // of the open file
};

}  // namespace trocar
