// The terminal: log lines and the progress bar, which share stderr. The only file that sees spdlog.
#include "base/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "base/quoted.h"
#include "base/timers.h"

namespace trocar {

namespace {

struct Terminal {
  spdlog::logger logger{"trocar", std::make_shared<spdlog::sinks::stderr_sink_mt>()};
  // Whether the cursor stands behind an unfinished progress line.
  std::atomic<bool> is_bar_open = false;

  Terminal() {
    logger.set_pattern("%v");
    logger.flush_on(spdlog::level::info);
  }
};

Terminal& terminal() {
  static Terminal the_terminal;
  return the_terminal;
}

void write_line(spdlog::level::level_enum level, const char* prefix, const std::string& line) {
  Terminal& t = terminal();
  if (!t.logger.should_log(level)) return;
  if (t.is_bar_open.exchange(false)) std::fputs("\r\033[K", stderr);
  t.logger.log(level, "{}{}", prefix, line);
}

std::size_t terminal_width() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : 80;
}

std::string percent_text(double fraction) {
  return std::to_string(static_cast<int>(100 * fraction + 1e-9)) + " %";
}

std::string bar_line(const std::string& title, double fraction, const std::string& note) {
  constexpr std::size_t width = 30;
  const auto n_done = static_cast<std::size_t>(fraction * static_cast<double>(width));
  std::string line = title + " [" + std::string(n_done, '#') + std::string(width - n_done, ' ');
  line += "] " + percent_text(fraction) + (note.empty() ? "" : "  " + note);
  // A line that wraps could not be redrawn in place.
  return std::string(first_characters(line, terminal_width() - 1));
}

// Tenths of the way; the small amount takes the rounding of n * 0.1 to the tenth it means.
int tenths(double fraction) {
  return static_cast<int>(10 * fraction + 1e-9);
}

}  // namespace

void start_log(int rank, bool is_quiet) {
  const auto loudest = is_quiet ? spdlog::level::warn : spdlog::level::info;
  terminal().logger.set_level(rank == 0 ? loudest : spdlog::level::off);
}

void log_info(const std::string& line) {
  write_line(spdlog::level::info, "", line);
}
void log_warning(const std::string& line) {
  write_line(spdlog::level::warn, "[warning] ", line);
}
void log_error(const std::string& line) {
  write_line(spdlog::level::err, "[error] ", line);
}

ProgressBar::ProgressBar(std::string title)
    : title_(std::move(title)), is_terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (terminal().is_bar_open.exchange(false)) std::fputc('\n', stderr);
}

void ProgressBar::update(double fraction, const std::string& note) {
  if (!terminal().logger.should_log(spdlog::level::info)) return;
  // Only a picture: a fraction that rounding took past its end is drawn as the end.
  fraction = fraction > 0 ? std::min(fraction, 1.0) : 0.0;
  if (is_terminal_) {
    const double now = monotonic_seconds();
    const bool is_end = fraction >= 1 && last_fraction_ < 1;
    if (!is_end && last_fraction_ >= 0 && now - last_draw_ < 0.1) return;
    std::fprintf(stderr, "\r%s\033[K", bar_line(title_, fraction, note).c_str());
    std::fflush(stderr);
    terminal().is_bar_open = true;
    last_draw_ = now;
  } else if (tenths(fraction) > tenths(std::max(last_fraction_, 0.0))) {
    log_info(title_ + ": " + percent_text(fraction) + (note.empty() ? "" : "  " + note));
  }
  last_fraction_ = fraction;
}

}  // namespace trocar
