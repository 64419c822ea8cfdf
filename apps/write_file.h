// Text files that the commands leave.
#pragma once

#include <string>

namespace trocar {

// Makes the file's folder, writes, and logs the name. Throws MachineError.
void write_file(const std::string& file, const std::string& text);

}  // namespace trocar
