// Lines for the person at the terminal, from rank 0 only. spdlog is seen by log.cpp alone.
#pragma once

#include <string>

namespace trocar {

// Called once, in main; ranks other than 0 print nothing afterwards.
void start_log(int rank, bool is_quiet);
void log_info(const std::string& line);
void log_warning(const std::string& line);
void log_error(const std::string& line);

// A progress line: redrawn in place on a terminal, a plain line every tenth of the way elsewhere;
// rank 0 only.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  // `fraction` done in [0, 1]; `note` stands behind the bar ("real-time factor 1.8").
  void update(double fraction, const std::string& note);

 private:
  std::string title_;
  double last_fraction_ = -1;
  double last_draw_ = 0;
  bool is_terminal_ = false;
};

}  // namespace trocar
