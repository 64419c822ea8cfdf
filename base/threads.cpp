#include "base/threads.h"

#include <immintrin.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "base/check.h"

namespace trocar {

namespace {

thread_local int n_threads_of_this = 1;
thread_local bool is_in_team = false;

using Call = void (*)(const void* body, int chunk);

// A number that one thread raises and another waits for: by looking, which costs less than being
// woken, as long as that has paid; where it has not, because the other one had no core, the next
// waits sleep at once, so that whoever needs this core gets it. No yielding: who yields waits for a
// whole time slice of the others.
class alignas(64) Signal {
 public:
  void raise() {
    {
      const std::scoped_lock lock(mutex_);
      value_.fetch_add(1, std::memory_order_release);
    }
    risen_.notify_one();
  }

  // For one thread.
  void wait_for(std::uint32_t value) {
    if (n_to_sleep_ > 0) {
      --n_to_sleep_;
    } else if (look_for(value)) {
      n_slept_ = 0;
      return;
    } else {
      n_to_sleep_ = n_slept_ = std::min(2 * n_slept_ + 1, most_slept);
    }
    std::unique_lock lock(mutex_);
    risen_.wait(lock, [&] { return has(value); });
  }

 private:
  static constexpr std::chrono::microseconds longest_look{50};
  static constexpr int looks_at_once = 16, most_slept = 255;

  bool has(std::uint32_t value) const { return value_.load(std::memory_order_acquire) == value; }

  bool look_for(std::uint32_t value) const {
    const auto start = std::chrono::steady_clock::now();
    do {
      for (int k = 0; k < looks_at_once; ++k) {
        if (has(value)) return true;
        _mm_pause();
      }
    } while (std::chrono::steady_clock::now() - start < longest_look);
    return false;
  }

  std::atomic<std::uint32_t> value_ = 0;
  int n_slept_ = 0, n_to_sleep_ = 0;
  std::mutex mutex_;
  std::condition_variable risen_;
};

class Team {
 public:
  ~Team() {
    call_ = nullptr;
    for (const auto& worker : workers_) worker->start.raise();
    for (const auto& worker : workers_) worker->thread.join();
  }

  // False if another thread has it.
  bool run(int n_chunks, Call call, const void* body) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return false;
    call_ = call;
    body_ = body;
    while (std::ssize(workers_) < n_chunks - 1) add_worker();
    const std::span team(workers_.data(), static_cast<std::size_t>(n_chunks - 1));
    for (const auto& worker : team) worker->start.raise();
    call(body, 0);
    for (const auto& worker : team) worker->end.wait_for(++worker->n_calls);
    return true;
  }

 private:
  struct Worker {
    Signal start, end;
    std::uint32_t n_calls = 0;
    std::thread thread;
  };

  void add_worker() {
    auto worker = std::make_unique<Worker>();
    const int chunk = static_cast<int>(std::ssize(workers_)) + 1;
    worker->thread = std::thread([this, &it = *worker, chunk] { work(chunk, it); });
    workers_.push_back(std::move(worker));
  }

  void work(int chunk, Worker& worker) {
    is_in_team = true;
    for (std::uint32_t n = 1;; ++n) {
      worker.start.wait_for(n);
      if (call_ == nullptr) return;
      call_(body_, chunk);
      worker.end.raise();
    }
  }

  std::mutex mutex_;  // of the thread that has it
  std::vector<std::unique_ptr<Worker>> workers_;
  Call call_ = nullptr;
  const void* body_ = nullptr;
};

}  // namespace

void set_thread_count(int n_threads) {
  CHECK_OP(n_threads, >=, 1);
  n_threads_of_this = n_threads;
}

int thread_count() {
  return n_threads_of_this;
}

void run_chunks(int n_chunks, Call call, const void* body) {
  static Team team;
  if (!is_in_team) {
    is_in_team = true;
    const bool is_done = team.run(n_chunks, call, body);
    is_in_team = false;
    if (is_done) return;
  }
  for (int chunk = 0; chunk < n_chunks; ++chunk) call(body, chunk);
}

static std::vector<int> affinity() {
  // The kernel refuses a mask that is too small for the machine; 1024 cores fit most.
  for (int n_cores = 1024; n_cores <= 1 << 20; n_cores *= 2) {
    cpu_set_t* mask = CPU_ALLOC(n_cores);
    CHECK(mask != nullptr);
    const std::size_t size = CPU_ALLOC_SIZE(n_cores);
    const bool is_known = sched_getaffinity(0, size, mask) == 0;
    const bool is_too_small = !is_known && errno == EINVAL;
    std::vector<int> cores;
    for (int core = 0; core < n_cores && is_known; ++core)
      if (CPU_ISSET_S(core, size, mask)) cores.push_back(core);
    CPU_FREE(mask);
    if (!is_too_small) return cores;
  }
  return {};
}

int available_cores() {
  return std::max(1, static_cast<int>(affinity().size()));
}

std::string core_list() {
  std::string list;
  for (const int core : affinity()) list += (list.empty() ? "" : " ") + std::to_string(core);
  return list;
}

}  // namespace trocar
