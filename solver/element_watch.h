// The look at elements by whoever has their strains in the stash: on its own, or as a part of the
// forces of a step, where the strains cost nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <mutex>
#include <span>

#include "solver/block_ranges.h"
#include "solver/watch.h"

namespace trocar {

// The least value so far; ties go to the lower global number.
struct Least {
  double value = std::numeric_limits<double>::infinity();
  std::int32_t number = -1;

  void take(double other, std::int32_t other_number) {
    if (other < value || (other == value && (number < 0 || other_number < number))) {
      value = other;
      number = other_number;
    }
  }
};

struct LeastOfElements {
  Least step, J;
};

// The order in which elements come does not matter.
class ElementWatch {
 public:
  // `stiffening` as in watch; both must live on.
  ElementWatch(const Part& part, std::span<double> stiffening)
      : part_(part), stiffening_(stiffening) {}

  // The blocks of the task, from `first` of the list on, into the thread's own `least`.
  void look(const Model& model, const ElementBlocks& blocks, const BlockKernels& kernels,
            const BlockTask& task, std::int64_t first, LeastOfElements& least) const;
  // What a thread has found. From any thread.
  void take(const LeastOfElements& least);
  // Of all but the nodes, which it calls finite.
  Watch result() const;

 private:
  const Part& part_;
  std::span<double> stiffening_;
  LeastOfElements least_;
  std::mutex mutex_;
};

}  // namespace trocar
