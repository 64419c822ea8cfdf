// A folder of its own for the files of one test, removed at its end.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace trocar::test {

class TemporaryFolder {
 public:
  // In memory where that is possible: thousands of small files are written.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  std::string file(const std::string& name) const;
  // Writes a file and returns its path.
  std::string file(const std::string& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

}  // namespace trocar::test
