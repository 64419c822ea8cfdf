#include "apps/read_scale.h"

#include <stdexcept>

#include "base/error.h"
#include "base/quoted.h"
#include "base/units.h"

namespace trocar {

double read_scale(const std::string& text) {
  double metres = 0;
  try {
    metres = parse_quantity(text, dim::length);
  } catch (const std::invalid_argument& trouble) {
    throw InputError("--scale: " + std::string(trouble.what()));
  }
  if (metres > 0) return metres;
  throw InputError("--scale: " + in_quotes(text) + " is out of range; allowed: > 0 m");
}

}  // namespace trocar
