// What a body will take is known before it is built, and refused where there is less.
#include "engine/memory_need.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/heap.h"
#include "engine_started.h"
#include "error_of.h"

namespace trocar {
namespace {

TEST(MemoryNeed, counts_generated_bodies_as_they_will_be) {
  for (const char* kind : {"box", "ball", "cylinder", "rectangle", "triangular-rectangle"})
    for (const char* elements : {"hex8", "tet4-kuhn"}) {
      const std::string scene =
          std::string("[time]\nduration = 1\n[tissue.shape]\ncells = [4, 5, 6]\nkind = \"") + kind +
          "\"\nelements = \"" + elements + "\"\n";
      const auto body = built(scene);
      const BodySize expected = size_of(body->s->mesh),
                     found = size_of(*body->s->scene.tissue.shape);
      EXPECT_EQ(found.n_hexahedra, expected.n_hexahedra) << scene;
      if (std::string(kind) == "triangular-rectangle") {  // as many as a rectangle would have
        EXPECT_GE(found.n_nodes, expected.n_nodes);
        EXPECT_GE(found.n_others, expected.n_others);
        continue;
      }
      EXPECT_EQ(found.n_nodes, expected.n_nodes) << scene;
      EXPECT_EQ(found.n_others, expected.n_others) << scene;
    }
}

TEST(MemoryNeed, beyond_what_there_is_is_refused_with_its_parts) {
  const auto error_with = [](double left) {
    const BodySize size{.n_nodes = 8'000'000, .n_hexahedra = 8'000'000};
    return error_of<SharedMachineError>([&] { check_memory(size, {}, 4, left); });
  };
  EXPECT_EQ(error_with(3e9), "");
  EXPECT_TRUE(contains(error_with(2e9),
                       "needs about 2.83 GB on each of 4 ranks, 2.03 GB of it for the mesh, which "
                       "every rank holds, and 0.8 GB for its part of the model, but only 2 GB"))
      << error_with(2e9);
}

// Sanitizers ask for terabytes.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(MemoryNeed, goes_by_the_limit_of_the_process) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit low{.rlim_cur = 100'000'000'000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_AS, &low);
  const double left = memory_of_process();
  const double for_a_rank = memory_for_a_rank(Communicator());
  setrlimit(RLIMIT_AS, &before);
  EXPECT_GT(left, 9e10);
  EXPECT_LT(left, 1e11);
  EXPECT_GT(for_a_rank, 1e6);
  EXPECT_LE(for_a_rank, left);
}
#endif

}  // namespace
}  // namespace trocar
