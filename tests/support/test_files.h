// Files that tests write and read, in folders of their own.
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "base/check.h"

namespace trocar {

// Returns the file.
inline std::string write_text(const std::string& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

inline std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// A new folder that goes away with the object. In memory where the machine has such a place: the
// tests write ten thousands of files.
class TestFolder {
 public:
  TestFolder() {
    const std::filesystem::path memory = "/dev/shm";
    const bool has_memory = access(memory.c_str(), W_OK) == 0;
    const auto place = has_memory ? memory : std::filesystem::temp_directory_path();
    path_ = (place / "trocar_XXXXXX").string();
    CHECK(mkdtemp(path_.data()) != nullptr);
  }
  ~TestFolder() {
    std::error_code trouble;
    std::filesystem::remove_all(path_, trouble);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string file(const std::string& name, std::string_view text) const {
    return write_text(file(name), text);
  }

 private:
  std::string path_;
};

}  // namespace trocar
