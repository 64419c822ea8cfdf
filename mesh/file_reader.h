// Reads an untrusted file in memory from front to back, as text or as binary numbers. Every read is
// bounded, and every failure is an InputError that says where: the line in text, the byte in binary
// data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace trocar {

class FileReader {
 public:
  // `bytes` outlives the reader.
  FileReader(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  const std::string& file() const { return file_; }
  std::size_t n_left() const { return bytes_.size() - at_; }
  std::size_t n_bytes() const { return bytes_.size(); }
  std::string_view rest() const { return bytes_.substr(at_); }
  // A reader of `part`, which lies in these bytes: its messages name the same lines.
  FileReader within(std::string_view part) const;

  // Text. White space is blank, tab, carriage return and new line.
  // True if nothing but white space is left (which is then skipped).
  bool is_at_end();
  // The next run of characters that are no white space; `what` names it if the file ends.
  std::string_view word(const char* what);
  // The same without moving on; "" at the end.
  std::string_view peek_word();
  std::int64_t integer(const char* what);
  // Always finite.
  double real(const char* what);
  // The rest of the current line without its end, and on to the next.
  std::string_view line();
  // True if only blanks are left before the end of the line.
  bool is_at_line_end();
  // Refuses anything but `expected` as the next word.
  void expect_word(std::string_view expected);

  // Binary. swaps_bytes: numbers are stored in the other byte order than this machine's.
  bool is_binary = false;
  bool swaps_bytes = false;
  // From the next line on; refuses anything before the end of this one.
  void begin_binary(bool swaps);
  std::string_view take(std::size_t n, const char* what);
  template <class T>
  T raw(const char* what) {
    return load_number<T>(take(sizeof(T), what).data(), swaps_bytes);
  }
  template <class T>
  static T load_number(const char* from, bool swaps) {
    char bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = from[swaps ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  // To be asked before anything is allocated: can `n` things of at least `n_bytes_each` still come?
  // Returns n.
  std::size_t check_count(std::int64_t n, std::size_t n_bytes_each, const char* what) const;

  // At the thing read last.
  [[noreturn]] void fail(const std::string& sentence) const;
  // About the file as a whole.
  [[noreturn]] void fail_file(const std::string& sentence) const;

 private:
  void skip_space();

  std::string file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;  // of the thing read last
};

}  // namespace trocar
