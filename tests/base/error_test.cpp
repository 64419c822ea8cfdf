#include "base/error.h"

#include <gtest/gtest.h>

using trocar::InputError;

TEST(InputErrors, begin_with_file_line_and_column) {
  EXPECT_STREQ(InputError({"a.toml", 3, 7}, "is wrong").what(), "a.toml:3:7: is wrong");
}

TEST(InputErrors, leave_out_what_is_unknown) {
  EXPECT_STREQ(InputError({"a.toml", 3, 0}, "is wrong").what(), "a.toml:3: is wrong");
  EXPECT_STREQ(InputError({"a.toml", 0, 0}, "is wrong").what(), "a.toml: is wrong");
  EXPECT_STREQ(InputError({"", 0, 0}, "is wrong").what(), "is wrong");
}
