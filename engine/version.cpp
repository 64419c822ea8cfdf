#include "engine/version.h"

namespace trocar {

std::string version_text() {
  return "trocar 0.1.0";
}

}  // namespace trocar
