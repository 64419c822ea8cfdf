// Folders and files that tests of engine/ write, and the sentence of an error.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"

namespace trocar {

// A new folder that goes away with the object. In memory where the machine has such a place: the
// tests write ten thousands of files.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string write_text(const std::string& file, const std::string& text);

std::string read_text(const std::string& file);

// The sentence of the Error that `action` throws, "" if it throws none.
template <class Error, class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

template <class Action>
std::string input_error_of(const Action& action) {
  return error_of<InputError>(action);
}

bool contains(const std::string& text, const std::string& part);

}  // namespace trocar
