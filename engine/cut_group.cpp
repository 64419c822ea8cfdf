#include "engine/cut_group.h"

#include <algorithm>
#include <utility>

#include "base/sort_unique.h"

namespace trocar {

namespace {

// What the group says to all: nodes to be found by all, or, with none, what its work has found.
struct Word {
  std::vector<std::int32_t> nodes;
  std::vector<std::byte> found;
};

}  // namespace

template <class Archive>
static void visit(Archive& a, Word& word) {
  a(word.nodes, word.found);
}

static std::vector<std::byte> bytes_of(Word word) {
  Saver save;
  save(word);
  return save.take();
}

CutGroup::CutGroup(Simulation& s, std::vector<int> ranks)
    : s_(s), ranks_(std::move(ranks)), members_(s.communicator->group(ranks_)) {}

bool CutGroup::is_everyone() const {
  return std::cmp_equal(ranks_.size(), s_.communicator->size());
}

// The first of the group says it, all ranks hear it.
void CutGroup::say(std::vector<std::byte>& bytes) const {
  s_.communicator->broadcast(bytes, ranks_.front());
}

void CutGroup::find(std::span<const std::int32_t> nodes) const {
  GlobalState& known = s_.cut_state;
  if (is_everyone()) return find_nodes(s_, nodes, *members_, known);
  std::vector<std::int32_t> asked;
  for (const std::int32_t i : nodes)
    if (known.is_known[i] == 0) asked.push_back(i);
  sort_unique(asked);
  const bool is_ours = std::ranges::all_of(
      asked, [&](std::int32_t i) { return std::ranges::binary_search(ranks_, s_.node_owner[i]); });
  if (is_ours) return find_nodes(s_, asked, *members_, known);
  std::vector<std::byte> bytes = bytes_of({.nodes = asked, .found = {}});
  say(bytes);
  find_nodes(s_, asked, *s_.communicator, known);
}

void CutGroup::tell(std::vector<std::byte> found) const {
  std::vector<std::byte> bytes = bytes_of({.nodes = {}, .found = std::move(found)});
  say(bytes);
  forget_state(s_.mesh.X.size(), s_.cut_state);
}

std::vector<std::byte> CutGroup::hear() const {
  Word word;
  do {
    std::vector<std::byte> bytes;
    say(bytes);
    Loader load(bytes);
    load(word);
    if (!word.nodes.empty()) motion_at(s_, word.nodes, *s_.communicator);
  } while (!word.nodes.empty());
  forget_state(s_.mesh.X.size(), s_.cut_state);
  return std::move(word.found);
}

}  // namespace trocar
