// Why a reader takes no text as a file.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "error_of.h"
#include "test_files.h"

namespace trocar::test {

// The message of read(file, scale), without the file's name in front.
template <class Read>
std::string refusal_by(const Read& read, const std::string& name, const std::string& content) {
  const TestFolder folder;
  const std::string file = folder.file(name, content);
  const std::string message = error_of([&] { read(file, 1); });
  EXPECT_TRUE(message.starts_with(file + ":")) << message;
  return message.substr(std::min(message.size(), file.size() + 1));
}

}  // namespace trocar::test
