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
  // Largest growth of a bound of omega^2 since an earlier look, at least 1, and of which element.
  double growth = 1;
  std::int32_t stiffest = -1;
};

// What one wants to know of elements.
struct WatchWishes {
  // (n local elements) As in watch; unless empty, all are computed exactly.
  std::span<double> stiffening = {};
  // (n local elements) What `stiffening` was at an earlier look; empty: never mind.
  std::span<const double> earlier = {};
};

// The order in which elements come does not matter: elements that cannot set any of the least
// values are told from these with less work.
class ElementWatch {
 public:
  // `part` and what the wishes point to must live on.
  ElementWatch(const Part& part, const WatchWishes& wishes) : part_(part), wishes_(wishes) {}

  // Global number of an element that is likely to set a least value, so that the others need not be
  // computed. Before all others.
  void begin_with(const Model& model, const State& state, std::int32_t element);
  // Where each thread starts.
  const LeastOfElements& first() const { return first_; }
  // The blocks of the task, from `first` of the list on, into the thread's own `least`.
  void look(const Model& model, const ElementBlocks& blocks, const BlockKernels& kernels,
            const BlockTask& task, std::int64_t first, LeastOfElements& least) const;
  // What a thread has found. From any thread.
  void take(const LeastOfElements& least);
  const LeastOfElements& found() const { return found_; }
  // Of all but the nodes, which it calls finite.
  Watch result() const;

 private:
  struct Lanes;
  void find_enough(const Lanes& lanes, const LeastOfElements& least,
                   std::span<double> enough) const;
  const Part& part_;
  WatchWishes wishes_;
  LeastOfElements first_, found_;
  std::mutex mutex_;
};

// Shows it all elements, without forces.
void watch_elements(const Model& model, const State& state, ElementWatch& elements);

}  // namespace trocar
