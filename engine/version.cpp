#include "engine/version.h"

namespace trocar {

std::string version_text() {
  return "trocar " TROCAR_VERSION;  // the project's, from CMakeLists.txt
}

}  // namespace trocar
