#include "base/host.h"

#include <gtest/gtest.h>
#include <sys/utsname.h>

namespace trocar {
namespace {

TEST(HostName, is_that_of_the_kernel) {
  utsname system{};
  ASSERT_EQ(uname(&system), 0);
  EXPECT_EQ(host_name(), system.nodename);
}

}  // namespace
}  // namespace trocar
