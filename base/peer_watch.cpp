#include "base/peer_watch.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/host.h"
#include "base/timers.h"

namespace trocar {

namespace {

// From a rank's end to the line about it: whoever ends all ranks has said why by then.
constexpr int reasons_ms = 100;
constexpr int end_by_mpirun_ms = 10000;

struct Peer {
  int rank = 0;
  long pid = 0;
  std::string host;
};

// Numbers of processes are those of a name space: a container may have its own.
std::string name_space() {
  std::array<char, 64> link{};
  const auto n = readlink("/proc/self/ns/pid", link.data(), link.size() - 1);
  return n > 0 ? link.data() : "-";
}

// Of all ranks that see each other's numbers, this one among them.
std::vector<Peer> peers_of(const Communicator& communicator) {
  const std::string own = host_name() + " " + name_space();
  const std::vector<std::string> all =
      communicator.all_gather(own + " " + std::to_string(getpid()));
  std::vector<Peer> peers;
  for (std::size_t r = 0; r < all.size(); ++r) {
    Peer peer{.rank = static_cast<int>(r)};
    std::string space;
    std::istringstream(all[r]) >> peer.host >> space >> peer.pid;
    if (peer.host + " " + space == own) peers.push_back(std::move(peer));
  }
  return peers;
}

bool has_ended(const pollfd& process) {
  return process.fd >= 0 && (process.revents & POLLIN) != 0;
}

// By a signal or a debugger.
bool is_suspended(long pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(in, text);
  const std::size_t name_end = text.rfind(')');  // the name before it may hold anything
  return name_end != std::string::npos && name_end + 2 < text.size() &&
         (text[name_end + 2] == 'T' || text[name_end + 2] == 't');
}

void tell_of_suspended(const Peer& peer, int seconds) {
  std::fprintf(stderr,
               "trocar: error: rank %d (process %ld on %s) has been stopped for %d s (SIGSTOP, a "
               "debugger), while the others wait for it: the run ends. --resume goes on from the "
               "last checkpoint, if there is one; --patience says how long to wait\n",
               peer.rank, peer.pid, peer.host.c_str(), seconds);
  std::fflush(stderr);
}

void tell(const Peer& peer) {
  std::fprintf(
      stderr,
      "trocar: error: rank %d (process %ld on %s) is gone: killed, unless it says why above "
      "(a system out of memory does that); mpirun ends the others. --resume goes on from "
      "the last checkpoint, if there is one\n",
      peer.rank, peer.pid, peer.host.c_str());
  std::fflush(stderr);
}

}  // namespace

struct PeerWatch::Thread {
  std::vector<Peer> peers;             // without this rank
  std::vector<int> seconds_suspended;  // (n_peers) in a row, of those in which this rank ran
  int rank = 0;
  int patience_seconds = 0;     // with a suspended one
  bool looks = false;           // for suspended ones: two on a host do
  std::vector<pollfd> process;  // (n_peers + 1) and what stops the watch
  std::thread thread;

  Thread() = default;
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  ~Thread() {
    for (const pollfd& each : process)
      if (each.fd >= 0) close(each.fd);
  }
  bool is_stopped() const { return process.back().revents != 0; }
  bool is_lowest_left() const {
    for (std::size_t k = 0; k < peers.size(); ++k)
      if (peers[k].rank < rank && !has_ended(process[k]) && seconds_suspended[k] == 0) return false;
    return true;
  }
  bool has_lost_one() const { return std::any_of(process.begin(), process.end() - 1, has_ended); }
  void look_for_suspended() {
    for (std::size_t k = 0; k < peers.size(); ++k)
      seconds_suspended[k] = is_suspended(peers[k].pid) ? seconds_suspended[k] + 1 : 0;
  }
  // Whether this rank is the one to tell of a peer that is suspended for too long, which it does.
  bool tells_of_suspended() const {
    const auto longest = std::ranges::max_element(seconds_suspended);
    if (*longest < patience_seconds || !is_lowest_left()) return false;
    tell_of_suspended(peers[longest - seconds_suspended.begin()], patience_seconds);
    return true;
  }
  void tell_of_lost() const {
    if (!is_lowest_left()) return;
    for (std::size_t k = 0; k < peers.size(); ++k)
      if (has_ended(process[k])) tell(peers[k]);
  }
  void run() {
    bool was_suspended = false;
    while (!is_stopped() && !has_lost_one()) {
      const double before = monotonic_seconds();
      const int n_events = poll(process.data(), process.size(), 1000);
      was_suspended = monotonic_seconds() - before > 2;
      if (n_events != 0 || !looks) continue;
      look_for_suspended();
      if (tells_of_suspended()) std::_Exit(static_cast<int>(ExitCode::machine));
    }
    if (is_stopped()) return;
    poll(&process.back(), 1, reasons_ms);
    if (is_stopped()) return;
    poll(process.data(), process.size(), 0);
    // Who is gone for a suspended rank has told of that, to which this may be news.
    const bool is_known = std::ranges::any_of(seconds_suspended, [](int s) { return s > 0; });
    if (!is_known && !was_suspended) tell_of_lost();
    poll(&process.back(), 1, end_by_mpirun_ms);
    if (!is_stopped()) std::_Exit(static_cast<int>(ExitCode::machine));
  }
};

PeerWatch::PeerWatch(const Communicator& communicator, int patience_seconds) {
  if (communicator.size() == 1) return;
  auto watch = std::make_unique<Thread>();
  watch->rank = communicator.rank();
  watch->patience_seconds = patience_seconds;
  for (Peer& peer : peers_of(communicator)) {
    if (peer.rank == communicator.rank()) continue;
    const auto fd = static_cast<int>(syscall(SYS_pidfd_open, peer.pid, 0));
    watch->process.push_back({.fd = fd, .events = POLLIN, .revents = 0});
    watch->peers.push_back(std::move(peer));
  }
  if (watch->peers.empty()) return;
  watch->seconds_suspended.assign(watch->peers.size(), 0);
  watch->looks = std::ranges::count_if(
                     watch->peers, [&](const Peer& peer) { return peer.rank < watch->rank; }) < 2;
  const int stop = eventfd(0, EFD_CLOEXEC);
  if (stop < 0) return;  // no descriptor left: a watch that could not be stopped
  watch->process.push_back({.fd = stop, .events = POLLIN, .revents = 0});
  // Signals are for the other threads.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  watch->thread = std::thread([w = watch.get()] { w->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  thread_ = std::move(watch);
}

PeerWatch::~PeerWatch() {
  if (!thread_) return;
  eventfd_write(thread_->process.back().fd, 1);
  thread_->thread.join();
}

}  // namespace trocar
