// The nodes' loop of NodeWorks, written once for any pack.
#pragma once

#include <cstdint>

#include "solver/kernels.h"
#include "solver/pack.h"

namespace trocar {

template <class Pack>
struct WorkLoops {
  static constexpr int width = pack_width<Pack>;

  static void add(const NodeWorks& given, std::int64_t n) {
    const NodeWorks task = given;
    std::int64_t k = 0;
    for (; k + width <= n; k += width) add_works(task, k);
    if (k < n) add_last_works(task, k, static_cast<int>(n - k));
  }

 private:
  // std::copy would be a function that other instruction sets have, too.
  template <class T>
  static void copy(const T* from, int n, T* to) {
    for (int k = 0; k < n; ++k) to[k] = from[k];
  }

  [[gnu::always_inline]] static void add_works(const NodeWorks& task, std::int64_t k) {
    const Pack v = 0.5 * (load<Pack>(task.v + k) + load<Pack>(task.after + k));
    store(task.v + k, v);
    if (task.swept != nullptr)
      store(task.swept + k, Pack(load<Pack>(task.swept + k) + task.dt * (v * v)));
    if (task.work != nullptr)
      store(task.work + k,
            Pack(load<Pack>(task.work + k) + task.dt * (v * load<Pack>(task.force + k))));
  }

  // Fewer than a register's: in copies, by the same instructions.
  [[gnu::always_inline]] static void add_last_works(const NodeWorks& task, std::int64_t k, int n) {
    double after[width] = {}, force[width] = {}, v[width] = {}, swept[width] = {}, work[width] = {};
    copy(task.after + k, n, after);
    copy(task.v + k, n, v);
    if (task.swept != nullptr) copy(task.swept + k, n, swept);
    if (task.work != nullptr) copy(task.work + k, n, work), copy(task.force + k, n, force);
    add_works({task.dt, after, force, v, swept, work}, 0);
    copy(v, n, task.v + k);
    if (task.swept != nullptr) copy(swept, n, task.swept + k);
    if (task.work != nullptr) copy(work, n, task.work + k);
  }
};

}  // namespace trocar
