// Name and number of this program.
#pragma once

#include <string>

namespace trocar {

std::string version_text();  // "trocar 0.1.0"

}  // namespace trocar
