// Another program fed through a pipe: started without a shell, watched while it is fed, never
// waited for without end.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trocar {

class EncoderProcess {
 public:
  // argv[0] is the path of the program. Its standard output goes nowhere. Taking no data for longer
  // than `patience` [s] is a failure; at its end it gets twice that. Throws MachineError.
  explicit EncoderProcess(const std::vector<std::string>& argv, double patience = 30);
  ~EncoderProcess();  // ends its input and waits; a program that does not end is killed
  EncoderProcess(const EncoderProcess&) = delete;
  EncoderProcess& operator=(const EncoderProcess&) = delete;

  // Throws MachineError with the program's last words if it has ended or takes nothing for too
  // long.
  void write(std::span<const std::uint8_t> bytes);
  // Ends its input and waits. Throws MachineError if it did not end well.
  void finish();
  pid_t pid() const { return pid_; }

 private:
  void read_words();
  bool listen(int ms, bool until_writable);
  void wait_until_writable();
  void end_input();
  bool has_ended();
  void wait_for_end();
  [[noreturn]] void fail(const std::string& what);

  std::string name_;
  int n_slices_;    // of patience
  pid_t pid_ = -1;  // -1: gone
  int status_ = 0;
  int input_ = -1, words_ = -1;  // our ends of the pipes
  std::string last_words_;
};

}  // namespace trocar
