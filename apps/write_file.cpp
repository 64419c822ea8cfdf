#include "apps/write_file.h"

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/log.h"

namespace trocar {

void write_file(const std::string& file, const std::string& text) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code ignored;  // the stream says what matters
  if (!folder.empty()) std::filesystem::create_directories(folder, ignored);
  std::ofstream stream(file);
  if (!(stream << text).flush())
    throw MachineError(file + ": can't be written (disk full or no permission)");
  log_info(file);
}

}  // namespace trocar
