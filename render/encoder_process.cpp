#include "render/encoder_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

extern char** environ;

namespace trocar {

namespace {

// Patience in slices of 0.1 s that we were awake for: a job that is suspended as a whole runs out
// of none.
constexpr int slice_ms = 100;
constexpr std::size_t most_words = 4096;

void close_end(int& end) {
  if (end >= 0) close(end);
  end = -1;
}

// Closes what ends it still has.
struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    std::array<int, 2> end{};
    if (pipe2(end.data(), O_CLOEXEC) != 0)
      throw MachineError(std::string("can't make a pipe to the encoder: ") + std::strerror(errno));
    read = end[0];
    write = end[1];
  }
  ~Pipe() {
    close_end(read);
    close_end(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
};

// The program starts with default signals and a process group of its own: Ctrl-C goes to us, and
// the film is finished.
int spawn(const std::vector<std::string>& argv, int input, int words, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, words, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  for (const std::string& a : argv) arguments.push_back(const_cast<char*>(a.c_str()));
  arguments.push_back(nullptr);
  const int error =
      posix_spawn(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

// A write to a program that has ended must be an error here, not the end of the process.
class NoSigpipe {
 public:
  NoSigpipe() {
    sigset_t pipe_only;
    sigemptyset(&pipe_only);
    sigaddset(&pipe_only, SIGPIPE);
    sigpending(&before_);
    pthread_sigmask(SIG_BLOCK, &pipe_only, &mask_);
  }
  ~NoSigpipe() {
    sigset_t pipe_only;
    sigemptyset(&pipe_only);
    sigaddset(&pipe_only, SIGPIPE);
    const timespec at_once{};
    if (!sigismember(&before_, SIGPIPE))
      while (sigtimedwait(&pipe_only, nullptr, &at_once) < 0 && errno == EINTR) {
      }
    pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
  }
  NoSigpipe(const NoSigpipe&) = delete;
  NoSigpipe& operator=(const NoSigpipe&) = delete;

 private:
  sigset_t mask_{}, before_{};
};

std::string end_of(int status) {
  if (WIFSIGNALED(status)) return "was ended by signal " + std::to_string(WTERMSIG(status));
  return "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

EncoderProcess::EncoderProcess(const std::vector<std::string>& argv, double patience)
    : name_(argv.at(0)), n_slices_(static_cast<int>(patience * 1000 / slice_ms)) {
  Pipe input, words;
  const int error = spawn(argv, input.read, words.write, pid_);
  if (error != 0) throw MachineError("can't start " + name_ + ": " + std::strerror(error));
  input_ = std::exchange(input.write, -1);
  words_ = std::exchange(words.read, -1);
  fcntl(input_, F_SETFL, O_NONBLOCK);
  fcntl(words_, F_SETFL, O_NONBLOCK);
}

EncoderProcess::~EncoderProcess() {
  end_input();
  if (pid_ >= 0) wait_for_end();
  close_end(words_);
}

void EncoderProcess::end_input() {
  close_end(input_);
}

void EncoderProcess::read_words() {
  if (words_ < 0) return;
  std::array<char, 1024> buffer;
  ssize_t n = 0;
  while ((n = read(words_, buffer.data(), buffer.size())) > 0) {
    last_words_.append(buffer.data(), static_cast<std::size_t>(n));
    if (last_words_.size() > most_words) last_words_.erase(0, last_words_.size() - most_words);
  }
}

bool EncoderProcess::has_ended() {
  if (pid_ >= 0 && waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ < 0;
}

// Reads its words for at most `ms`, or until `input_` takes more (if asked). True if it does or is
// broken.
bool EncoderProcess::listen(int ms, bool until_writable) {
  std::array<pollfd, 2> ends{
      pollfd{.fd = words_, .events = POLLIN, .revents = 0},
      pollfd{.fd = until_writable ? input_ : -1, .events = POLLOUT, .revents = 0}};
  poll(ends.data(), ends.size(), ms);
  if (ends[0].revents & POLLIN) {
    read_words();
  } else if (ends[0].revents != 0) {
    close_end(words_);  // it will say no more; polling this end would return at once for ever
  }
  return ends[1].revents != 0;
}

void EncoderProcess::wait_for_end() {
  constexpr int nap_ms = 5;
  for (int nap = 0; nap < 2 * n_slices_ * slice_ms / nap_ms && !has_ended(); ++nap)
    listen(nap_ms, false);
  if (has_ended()) return read_words();
  kill(pid_, SIGKILL);
  waitpid(pid_, &status_, 0);
  pid_ = -1;
}

void EncoderProcess::fail(const std::string& what) {
  while (!last_words_.empty() && last_words_.back() == '\n') last_words_.pop_back();
  const std::size_t line = last_words_.rfind('\n');
  const std::string last = line == std::string::npos ? last_words_ : last_words_.substr(line + 1);
  throw MachineError(name_ + " " + what + (last.empty() ? "" : ": " + last));
}

void EncoderProcess::wait_until_writable() {
  for (int slice = 0; slice < n_slices_; ++slice)
    if (listen(slice_ms, true) || has_ended()) return;
  kill(pid_, SIGKILL);
  wait_for_end();
  fail("took no data for too long and was ended");
}

void EncoderProcess::write(std::span<const std::uint8_t> bytes) {
  const NoSigpipe no_signal;
  while (!bytes.empty()) {
    const ssize_t n = ::write(input_, bytes.data(), bytes.size());
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (n < 0 && errno == EAGAIN) {
      wait_until_writable();
    } else if (n < 0 && errno != EINTR) {
      end_input();
      wait_for_end();
      fail(end_of(status_));
    }
  }
}

void EncoderProcess::finish() {
  end_input();
  if (pid_ >= 0) wait_for_end();
  if (status_ != 0) fail(end_of(status_));
}

}  // namespace trocar
