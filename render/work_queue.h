// A thread of its own that works through a short queue in order, and keeps the first error for
// whoever asks.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace trocar {

template <class Job>
class WorkQueue {
 public:
  // `work` is called in the queue's thread for each job; after the first exception the rest is
  // dropped.
  WorkQueue(std::size_t length, std::function<void(Job&)> work)
      : length_(length), work_(std::move(work)), thread_([this] { run(); }) {}
  ~WorkQueue() { close(); }
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  // Blocks while the queue is full. Throws what `work` threw.
  void add(Job job) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return trouble_ || jobs_.size() < length_; });
    if (trouble_) std::rethrow_exception(trouble_);
    jobs_.push_back(std::move(job));
    changed_.notify_all();
  }
  // Waits until all that was added is done. Throws what `work` threw.
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return trouble_ || (jobs_.empty() && !is_busy_); });
    if (trouble_) std::rethrow_exception(trouble_);
  }
  // The same, and ends the thread: no more can be added.
  void finish() {
    close();
    if (trouble_) std::rethrow_exception(trouble_);
  }

 private:
  void close() {
    {
      const std::lock_guard lock(mutex_);
      is_closing_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [&] { return is_closing_ || !jobs_.empty(); });
      if (jobs_.empty()) return;
      Job job = std::move(jobs_.front());
      jobs_.pop_front();
      is_busy_ = true;
      changed_.notify_all();
      lock.unlock();
      std::exception_ptr trouble;
      try {
        work_(job);
      } catch (...) {
        trouble = std::current_exception();
      }
      lock.lock();
      is_busy_ = false;
      trouble_ = trouble;
      changed_.notify_all();
      if (trouble_) return;
    }
  }

  const std::size_t length_;
  const std::function<void(Job&)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool is_busy_ = false, is_closing_ = false;
  std::exception_ptr trouble_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace trocar
