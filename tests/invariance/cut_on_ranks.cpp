// The ranks around a blade cut, the others take over what comes out: with the bits of one rank.
// scripts/on_ranks 4 cut_on_ranks: every rank runs the same tests beside the others.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

#include "base/log.h"
#include "base/threads.h"
#include "engine/build.h"
#include "engine/cut_group.h"
#include "engine/frame.h"
#include "engine/state_digest.h"
#include "engine_checkpoint.h"
#include "scene_parts.h"
#include "solver/step.h"
#include "test_files.h"

namespace trocar {
namespace {

Communicator* world = nullptr;
constexpr int n_frames = 20;

struct Running {
  TestFolder folder;
  LoadedScene loaded;
  std::unique_ptr<Simulation> s;
  Outputs outputs;
};

// 120 x 20 x 20 mm, long enough for each rank to have a slice of it.
std::string bar(const std::string& elements, const std::string& blades) {
  return time_table("0.4 s", 50) + "[tissue.shape]\nkind = \"box\"\nelements = \"" + elements +
         "\"\nhigh = [\"120 mm\", \"20 mm\", \"20 mm\"]\ncells = [30, 5, 5]\n" + tissue_of_kpa(4) +
         solver_table("-3", 20) + "[[support]]\nregion = \"z-\"\n" + blades;
}

// From above, down to z = 8 mm, between two places along the bar [mm].
std::string blade(int from, int to, const std::string& name = "scalpel") {
  const std::string forward = to > from ? "[1, 0, 0]" : "[-1, 0, 0]";
  const auto key = [&](double time, int x) {
    return "{ time = " + std::to_string(time) + ", position = [\"" + std::to_string(x) +
           " mm\", \"10.7 mm\", \"8 mm\"], forward = " + forward + " },\n";
  };
  return scalpel_along("40 mm", key(0.02, from) + key(0.4, to)) + "name = \"" + name + "\"\n";
}

const std::string along = blade(-4, 130);
const std::string at_one_end = blade(-4, 14), at_the_other_end = blade(124, 106, "other scalpel");

std::unique_ptr<Running> built_on(Communicator& ranks, const std::string& text) {
  auto running = std::make_unique<Running>();
  running->outputs.folder = running->folder.path();
  running->loaded = load_scene(write_text(running->folder.file("s.toml"), text), {});
  running->s = build(running->loaded, ranks);
  return running;
}

void run_frames(Running& running, int n) {
  for (int k = 0; k < n; ++k) run_frame(*running.s, running.outputs);
}

// After the scene's frames on one rank.
std::uint64_t digest_alone(const std::string& text) {
  static std::map<std::string, std::uint64_t> known;
  if (const auto at = known.find(text); at != known.end()) return at->second;
  std::uint64_t digest = 0;
  if (world->is_root()) {
    Communicator alone;
    const auto running = built_on(alone, text);
    run_frames(*running, n_frames);
    digest = state_digest(*running->s);
  }
  return known[text] = world->all_sum(digest);
}

void expect_digest_of_one_rank(const std::string& text, const Running& running) {
  EXPECT_EQ(state_digest(*running.s), digest_alone(text));
}

int n_edits(const Simulation& s) {
  std::int64_t n = 0;
  for (const CutStage& stage : s.cuts)
    for (const CutRecord& stroke : stage.strokes) n += stroke.n_edits;
  return int(n);
}

void expect_gathers(const std::vector<int>& ranks) {
  const Communicator* const group = world->group(ranks);
  EXPECT_EQ(group != nullptr, std::ranges::binary_search(ranks, world->rank()));
  if (group == nullptr) return;
  EXPECT_EQ(group->size(), int(ranks.size()));
  const std::vector<double> own{double(world->rank())};
  EXPECT_EQ(group->all_gather(own), std::vector<double>(ranks.begin(), ranks.end()));
}

TEST(Group, of_ranks_gathers_what_they_have_and_is_made_once) {
  for (const std::vector<int>& ranks : {std::vector{1, 3}, {2}, {0, 1, 2, 3}, {1, 3}}) {
    expect_gathers(ranks);
    const Communicator* const group = world->group(ranks);
    EXPECT_EQ(world->group(ranks), group);
  }
}

// Of four ranks.
std::vector<std::vector<int>> all_groups() {
  std::vector<std::vector<int>> groups;
  for (unsigned set = 1; set < 16; ++set) {
    std::vector<int>& ranks = groups.emplace_back();
    for (int r = 0; r < 4; ++r)
      if ((set >> r & 1) != 0) ranks.push_back(r);
  }
  return groups;
}

// Those that were asked for last, once those of other tests are gone; Open MPI has some 65,000 at a
// time.
TEST(Group, many_leave_few) {
  const std::vector<std::vector<int>> groups = all_groups();
  std::vector<std::vector<int>> last;
  int n_wrong = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::vector<int>& ranks = groups[std::size_t(k * (k % 11 + 7)) % groups.size()];
    expect_gathers(ranks);
    if (ranks.size() == 4) continue;
    std::erase(last, ranks);
    last.push_back(ranks);
    if (last.size() > Communicator::most_groups) last.erase(last.begin());
    const auto n = std::ranges::count_if(last, [](const std::vector<int>& some) {
      return some.size() > 1 && std::ranges::binary_search(some, world->rank());
    });
    n_wrong += k > 100 && world->n_groups() != std::size_t(n) ? 1 : 0;
  }
  EXPECT_EQ(n_wrong, 0);
}

// Whoever owns them.
TEST(CutGroup, finds_all_nodes_and_tells_all_ranks) {
  const auto running = built_on(*world, bar("tet4-five", at_one_end));
  Simulation& s = *running->s;
  run_frames(*running, 3);
  std::vector<std::int32_t> all, some;
  for (std::int32_t i = 0; i < s.mesh.n_nodes(); ++i) (i % 3 == 0 ? some : all).push_back(i);
  all.insert(all.end(), some.begin(), some.end());
  const std::vector<Vec3> expected = gather_state(s).x;
  for (const std::vector<int>& ranks : {std::vector{0}, {1, 2}, {3}, {0, 1, 2, 3}}) {
    forget_state(s.mesh.X.size(), s.cut_state);
    const CutGroup group(s, ranks);
    const auto x = found_by<std::vector<Vec3>>(group, [&] {
      group.find(some);
      group.find(all);
      return s.cut_state.x;
    });
    EXPECT_EQ(x, expected);
    EXPECT_EQ(s.cut_state.known.empty(), !group.is_everyone());
  }
}

TEST(CutOnRanks, is_made_by_those_around_the_blade_alone) {
  const std::string scene = bar("tet4-five", at_one_end + at_the_other_end);
  const auto running = built_on(*world, scene);
  Simulation& s = *running->s;
  run_frames(*running, n_frames);
  EXPECT_GT(n_edits(s), 4);
  for (const CutStage& stage : s.cuts) {
    const std::int64_t n_ranks = stage.strokes.at(0).n_ranks;
    EXPECT_LE(n_ranks, 2);
    // A rank that has not cut knows nothing of where the blade went.
    const bool has_cut = !stage.tet.stroke().hit.empty();
    EXPECT_EQ(world->all_sum(std::uint64_t{has_cut}), std::uint64_t(n_ranks));
    EXPECT_TRUE(stage.tet.is_prepared(s.mesh));
  }
  expect_digest_of_one_rank(scene, *running);
}

// Ranks join and leave; those that join go on from where the others were.
TEST(CutOnRanks, has_the_bits_of_one_rank_across_all_borders_however_few_begin_it) {
  for (const std::string elements : {"tet4-five", "hex8"})
    for (const double margin : {-1., 1., 1000.}) {
      const std::string scene = bar(elements, along);
      const auto running = built_on(*world, scene);
      Simulation& s = *running->s;
      s.cuts[0].margin = margin;
      run_frames(*running, n_frames);
      EXPECT_GT(n_edits(s), 10);
      const std::int64_t n_ranks = s.cuts[0].strokes.at(0).n_ranks;
      if (elements == "tet4-five" || margin > 100) {  // which ranks have slices of
        EXPECT_EQ(n_ranks == 4, margin > 100) << n_ranks << " with " << margin;
      }
      EXPECT_TRUE(s.cuts[0].tet.is_prepared(s.mesh));
      expect_digest_of_one_rank(scene, *running);
    }
}

// Three blades at a time, with groups of others asked for in between.
TEST(CutOnRanks, leaves_few_groups_behind_all_strokes) {
  const std::string scene =
      bar("tet4-five", at_one_end + at_the_other_end + scalpel_along("40 mm", R"(
  { time = 0.02, position = ["-4 mm", "5.3 mm", "8 mm"], forward = [1, 0, 0] },
  { time = 0.4, position = ["124 mm", "5.3 mm", "8 mm"], forward = [1, 0, 0] },
)") + "name = \"long scalpel\"\n");
  const auto running = built_on(*world, scene);
  const std::vector<std::vector<int>> groups = all_groups();
  for (int frame = 0; frame < n_frames; ++frame) {
    run_frames(*running, 1);
    EXPECT_LE(world->n_groups(), Communicator::most_groups);
    for (int k = 0; k < frame % 10; ++k) world->group(groups[std::size_t(3 * frame + k) % 15]);
  }
  for (const CutStage& stage : running->s->cuts) EXPECT_EQ(stage.strokes.size(), 1U);
  EXPECT_GT(n_edits(*running->s), 10);
  expect_digest_of_one_rank(scene, *running);
}

// Of its bytes on the root, on all ranks.
Checkpoint shared(const Checkpoint& mine) {
  std::vector<std::byte> bytes = checkpoint_to_bytes(mine);
  world->broadcast(bytes);
  return checkpoint_from_bytes(bytes, "shared");
}

void expect_to_go_on_from(int at, const std::string& scene) {
  const auto first = built_on(*world, scene), second = built_on(*world, scene);
  run_frames(*first, at);
  restore_checkpoint(shared(take_checkpoint(*first->s)), *second->s);
  run_frames(*first, n_frames - at);
  run_frames(*second, n_frames - at);
  expect_digest_of_one_rank(scene, *first);
  expect_digest_of_one_rank(scene, *second);
}

TEST(CutOnRanks, goes_on_from_checkpoints_within_the_stroke) {
  const std::string scene = bar("tet4-five", along);
  int n_without_root = 0;
  for (const int at : {4, 8, 12, 16}) {
    const auto running = built_on(*world, scene);
    run_frames(*running, at);
    const std::vector<int>& keepers = running->s->cuts[0].keepers;
    n_without_root += !keepers.empty() && keepers.front() > 0 ? 1 : 0;
    expect_to_go_on_from(at, scene);
  }
  EXPECT_GT(n_without_root, 0);
}

// They meet at x = 60 mm, after 13 frames, and pass each other.
TEST(CutOnRanks, goes_on_from_checkpoints_where_two_blades_meet) {
  for (const std::string elements : {"tet4-five", "hex8"})
    for (const int at : {11, 15})
      expect_to_go_on_from(at, bar(elements, blade(-4, 90) + blade(124, 30, "other scalpel")));
}

}  // namespace
}  // namespace trocar

int main(int argc, char** argv) {
  trocar::MpiSession session(&argc, &argv);
  trocar::world = &session.world();
  testing::InitGoogleTest(&argc, argv);
  trocar::start_log(session.world().rank(), true);
  trocar::set_thread_count(1);
  trocar::select_simd("auto");
  if (session.world().size() != 4) return 1;
  return RUN_ALL_TESTS();
}
