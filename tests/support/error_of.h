// Sentences of errors.
#pragma once

#include <string>

#include "base/error.h"

namespace trocar {

// The sentence of the Error that `action` throws, "" if it throws none.
template <class Error = InputError, class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace trocar
