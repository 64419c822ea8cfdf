// The machine that this process runs on.
#pragma once

#include <string>

namespace trocar {

std::string host_name();

}  // namespace trocar
