// The ranks that work on a cut: the owners of what is around the blade. They tell each other where
// nodes are and decide alike. The others wait, tell of nodes of theirs if the cut looks farther
// than was thought, and take over what comes out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/archive.h"
#include "engine/simulation.h"

namespace trocar {

class CutGroup {
 public:
  // ranks: ascending, one at least, the same on all ranks. Collective.
  CutGroup(Simulation& s, std::vector<int> ranks);

  const std::vector<int>& ranks() const { return ranks_; }
  bool is_everyone() const;
  bool has_this_rank() const { return members_ != nullptr; }

  // From here on s.cut_state has these nodes on the group's ranks, all of which call this and no
  // others.
  void find(std::span<const std::int32_t> nodes) const;

  // What the work has found: all of the group tell it and all others hear it, who until then answer
  // what the group asks for. No rank knows of any node from then on.
  void tell(std::vector<std::byte> found) const;
  std::vector<std::byte> hear() const;

 private:
  void say(std::vector<std::byte>& bytes) const;

  Simulation& s_;
  std::vector<int> ranks_;
  const Communicator* members_;  // null on other ranks
};

// What `work`, which throws no error of input or simulation, finds on the group's ranks, on all
// ranks. Collective.
template <class Found, class Work>
Found found_by(const CutGroup& group, const Work& work) {
  if (group.is_everyone()) return work();
  if (!group.has_this_rank()) {
    const std::vector<std::byte> bytes = group.hear();
    Found found;
    Loader load(bytes);
    load(found);
    return found;
  }
  Found found = work();
  Saver save;
  save(found);
  group.tell(save.take());
  return found;
}

}  // namespace trocar
