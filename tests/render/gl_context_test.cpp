#include "render/gl_context.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "base/error.h"
#include "error_of.h"
#include "render/gl_program.h"

using namespace trocar;

TEST(GlContext, missing_library_is_an_error_that_names_the_package) {
  const std::array<const char*, 2> names = {"libno-such-mesa.so.1", "libno-such-mesa.so"};
  const std::string what = error_of<MachineError>([&] { load_osmesa(names); });
  EXPECT_TRUE(contains(what, "libosmesa6")) << what;
  EXPECT_TRUE(contains(what, "libno-such-mesa")) << what;
}

TEST(GlContext, thread_count_that_the_user_set_stays) {
  const char* old = std::getenv("LP_NUM_THREADS");
  const std::string before = old ? old : "0";
  setenv("LP_NUM_THREADS", "1", 1);
  { const GlContext context; }
  EXPECT_STREQ(std::getenv("LP_NUM_THREADS"), "1");
  unsetenv("LP_NUM_THREADS");
  { const GlContext context; }
  EXPECT_STREQ(std::getenv("LP_NUM_THREADS"), "0");
  setenv("LP_NUM_THREADS", before.c_str(), 1);
}

TEST(GlProgram, broken_shader_is_an_error_with_the_compilers_words) {
  const GlContext context;
  const GlCurrent current(context);
  const std::string good = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n";
  const std::string what = error_of<MachineError>([&] {
    make_program(context, "broken one", good, "#version 330 core\nvoid main() { nonsense; }\n");
  });
  EXPECT_TRUE(contains(what, "broken one")) << what;
  EXPECT_TRUE(contains(what, "nonsense")) << what;
}
