// How a place in the user's file is written in front of a sentence.
#include "base/error.h"

namespace trocar {

static std::string placed(const SourcePlace& place, const std::string& sentence) {
  std::string text = place.file;
  if (place.line > 0) text.append(":").append(std::to_string(place.line));
  if (place.line > 0 && place.column > 0) text.append(":").append(std::to_string(place.column));
  return text.empty() ? sentence : text + ": " + sentence;
}

InputError::InputError(const SourcePlace& place, const std::string& sentence)
    : std::runtime_error(placed(place, sentence)) {}

}  // namespace trocar
