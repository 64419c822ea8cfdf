#include "apps/write_file.h"

#include <filesystem>

#include "base/log.h"
#include "base/whole_file.h"

namespace trocar {

void write_file(const std::string& file, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code ignored;  // what writes says what matters
  if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
  write_whole_file(file, text);
  log_info(file);
}

}  // namespace trocar
