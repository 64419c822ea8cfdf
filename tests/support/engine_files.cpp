#include "engine_files.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <iterator>

namespace trocar {

TestFolder::TestFolder() {
  const std::filesystem::path memory = "/dev/shm";
  const bool has_memory = access(memory.c_str(), W_OK) == 0;
  const std::filesystem::path place = has_memory ? memory : std::filesystem::temp_directory_path();
  std::string pattern = (place / "trocar_XXXXXX").string();
  EXPECT_NE(mkdtemp(pattern.data()), nullptr);
  path_ = pattern;
}

TestFolder::~TestFolder() {
  std::error_code trouble;
  std::filesystem::remove_all(path_, trouble);
}

std::string write_text(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace trocar
