#include "failing_files.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

enum class Fault { none, kill, half, shortened, full, eio };

struct Plan {
  Fault fault = Fault::none;
  int at = 0;  // number of the call
  std::string text, folder;
};

// Never destroyed: files are closed after the last destructor.
Plan& plan() {
  static Plan& it = *new Plan;
  return it;
}

std::atomic<int> n_calls = 0;
constexpr int most_files = 1024;
// What is open below the folder, by number; "" elsewhere.
std::array<std::array<char, 300>, most_files> name_of{};

// The function behind ours.
template <class Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_below(const char* file) {
  const std::string& folder = plan().folder;
  return !folder.empty() && std::strncmp(file, folder.c_str(), folder.size()) == 0;
}

void note_open(int number, const char* file) {
  if (number < 0 || number >= most_files) return;
  std::snprintf(name_of[number].data(), name_of[number].size(), "%s", is_below(file) ? file : "");
}

void note_closed(int number) {
  if (number >= 0 && number < most_files) name_of[number][0] = '\0';
}

const char* file_of(int number) {
  return number >= 0 && number < most_files ? name_of[number].data() : "";
}

void tell(const char* call, const char* file) {
  char line[500];
  const int n = std::snprintf(line, sizeof line, "failing_files: %s, %s of %s\n",
                              plan().text.c_str(), call, file);
  const auto say = real(&write, "write");
  if (n > 0) [[maybe_unused]]
    const ssize_t told = say(STDERR_FILENO, line, std::size_t(n));
}

[[noreturn]] void die() {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}

enum class Do { all, half, half_and_die, fail };

// What becomes of a call on the file. takes_space: may fail for want of it.
Do next(const char* call, const char* file, bool takes_space = true) {
  if (file[0] == '\0') return Do::all;
  const Plan& p = plan();
  const int k = ++n_calls;
  if (p.fault == Fault::full && !takes_space) return Do::all;
  const bool is_hit = k == p.at, is_behind = k > p.at;
  if (p.fault == Fault::none || (!is_hit && !(is_behind && p.fault == Fault::full))) return Do::all;
  tell(call, file);
  if (p.fault == Fault::kill) die();
  if (p.fault == Fault::half) return Do::half_and_die;
  if (p.fault == Fault::shortened || (p.fault == Fault::full && is_hit)) return Do::half;
  errno = p.fault == Fault::eio ? EIO : ENOSPC;
  return Do::fail;
}

// Of calls that write nothing.
bool fails(const char* call, const char* file, bool takes_space = true) {
  const Do what = next(call, file, takes_space);
  if (what == Do::half_and_die) die();
  if (what == Do::half && plan().fault == Fault::full) {
    errno = ENOSPC;
    return true;
  }
  return what == Do::fail;
}

// Of those that free space.
void count_removal(const char* call, const char* file) {
  if (!is_below(file)) return;
  const int k = ++n_calls;
  const Fault fault = plan().fault;
  if (k != plan().at || (fault != Fault::kill && fault != Fault::half)) return;
  tell(call, file);
  die();
}

// put(n): writes so many of the bytes or items.
template <class Put>
ssize_t written(const char* call, const char* file, std::size_t n, const Put& put) {
  const Do what = next(call, file);
  if (what == Do::fail) return -1;
  const ssize_t done = put(what == Do::all ? n : n / 2);
  if (what == Do::half_and_die) die();
  return done;
}

// It makes or empties a file, or may write into it.
bool is_for_writing(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY;
}

template <class Open>
int opened(const char* file, int flags, mode_t mode, const Open& open_it) {
  if (is_for_writing(flags) && is_below(file) && fails("open", file)) return -1;
  const int number = open_it(file, flags, mode);
  note_open(number, is_for_writing(flags) ? file : "");
  return number;
}

template <class Open>
FILE* stream_opened(const char* file, const char* mode, const Open& open_it) {
  const bool is_written = std::strpbrk(mode, "wa+") != nullptr;
  if (is_written && is_below(file) && fails("fopen", file)) return nullptr;
  FILE* const stream = open_it(file, mode);
  if (stream != nullptr) note_open(fileno(stream), is_written ? file : "");
  return stream;
}

mode_t mode_of(int flags, va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? mode_t(va_arg(more, int)) : mode_t(0);
}

// Before any file is opened.
[[gnu::constructor]] void read_environment() {
  const char* const fault = std::getenv("TROCAR_FAULT");
  const char* const folder = std::getenv("TROCAR_FAULT_FOLDER");
  if (fault != nullptr && folder != nullptr) fail_files(fault, folder);
}

}  // namespace

extern "C" {

void fail_files(const char* fault, const char* folder) {
  const std::string text = fault, what = text.substr(0, text.find('@'));
  constexpr const char* names[] = {"none", "kill", "half", "short", "full", "eio"};
  Plan& p = plan();
  p = {.text = text, .folder = folder};
  for (int k = 0; k < 6; ++k)
    if (what == names[k]) p.fault = Fault(k);
  if (what.size() < text.size()) p.at = std::atoi(text.c_str() + what.size() + 1);
  n_calls = 0;
}

int n_file_calls() {
  return n_calls;
}

int open(const char* file, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened(file, flags, mode, real(&open, "open"));
}

int open64(const char* file, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return opened(file, flags, mode, real(&open64, "open64"));
}

FILE* fopen(const char* file, const char* mode) {
  return stream_opened(file, mode, real(&fopen, "fopen"));
}

FILE* fopen64(const char* file, const char* mode) {
  return stream_opened(file, mode, real(&fopen64, "fopen64"));
}

int close(int number) {
  note_closed(number);
  return real(&close, "close")(number);
}

int fclose(FILE* stream) {
  const int number = fileno(stream);
  const bool is_lost = number >= 0 && fails("fclose", file_of(number));
  const int trouble = errno;
  note_closed(number);
  const int result = real(&fclose, "fclose")(stream);
  if (is_lost) errno = trouble;
  return is_lost ? EOF : result;
}

ssize_t write(int number, const void* bytes, size_t n) {
  const auto put = real(&write, "write");
  return written("write", file_of(number), n,
                 [&](std::size_t some) { return put(number, bytes, some); });
}

// Of the parts half, too: one is enough.
ssize_t writev(int number, const iovec* parts, int n) {
  const auto put = real(&writev, "writev");
  return written("writev", file_of(number), std::size_t(n),
                 [&](std::size_t some) { return put(number, parts, int(some)); });
}

ssize_t pwrite64(int number, const void* bytes, size_t n, off64_t at) {
  const auto put = real(&pwrite64, "pwrite64");
  return written("pwrite", file_of(number), n,
                 [&](std::size_t some) { return put(number, bytes, some, at); });
}

size_t fwrite(const void* bytes, size_t size, size_t n, FILE* stream) {
  const auto put = real(&fwrite, "fwrite");
  const int number = fileno(stream);
  if (size != 1) return put(bytes, size, n, stream);
  const ssize_t done = written("fwrite", number < 0 ? "" : file_of(number), n,
                               [&](std::size_t k) { return ssize_t(put(bytes, 1, k, stream)); });
  if (done >= 0 && std::size_t(done) != n) errno = ENOSPC;
  return done < 0 ? 0 : std::size_t(done);
}

int fsync(int number) {
  return fails("fsync", file_of(number)) ? -1 : real(&fsync, "fsync")(number);
}

int fdatasync(int number) {
  return fails("fdatasync", file_of(number)) ? -1 : real(&fdatasync, "fdatasync")(number);
}

int ftruncate(int number, off_t size) noexcept {
  if (fails("ftruncate", file_of(number), false)) return -1;
  return real(&ftruncate, "ftruncate")(number, size);
}

int ftruncate64(int number, off64_t size) noexcept {
  if (fails("ftruncate", file_of(number), false)) return -1;
  return real(&ftruncate64, "ftruncate64")(number, size);
}

int rename(const char* from, const char* to) noexcept {
  if (is_below(to) && fails("rename", to)) return -1;
  return real(&rename, "rename")(from, to);
}

int unlink(const char* file) noexcept {
  count_removal("unlink", file);
  return real(&unlink, "unlink")(file);
}

int remove(const char* file) noexcept {
  count_removal("remove", file);
  return real(&remove, "remove")(file);
}

int mkdir(const char* folder, mode_t mode) noexcept {
  if (is_below(folder) && fails("mkdir", folder)) return -1;
  return real(&mkdir, "mkdir")(folder, mode);
}

}  // extern "C"
