// Bounded reading of text and binary numbers.
#include "mesh/file_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/quoted.h"

namespace trocar {

static bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f';
}

void FileReader::skip_space() {
  while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
  begin_ = at_;
}

FileReader FileReader::within(std::string_view part) const {
  const auto begin = static_cast<std::size_t>(part.data() - bytes_.data());
  FileReader reader(file_, bytes_.substr(0, begin + part.size()));
  reader.at_ = reader.begin_ = begin;
  return reader;
}

bool FileReader::is_at_end() {
  skip_space();
  return at_ == bytes_.size();
}

std::string_view FileReader::peek_word() {
  skip_space();
  std::size_t end = at_;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  return bytes_.substr(at_, end - at_);
}

std::string_view FileReader::word(const char* what) {
  const std::string_view found = peek_word();
  if (found.empty()) fail(std::string("the file ends where ") + what + " should stand");
  at_ += found.size();
  return found;
}

// from_chars knows no plus sign.
static std::string_view without_plus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return has_plus ? text.substr(1) : text;
}

std::int64_t FileReader::integer(const char* what) {
  const std::string_view text = without_plus(word(what));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    fail(std::string(what) + " is " + in_quotes(text) + ", which no 64-bit integer can hold");
  if (error != std::errc() || end != text.data() + text.size())
    fail(std::string(what) + " should be an integer, not " + in_quotes(text));
  return value;
}

double FileReader::real(const char* what) {
  const std::string_view text = without_plus(word(what));
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    fail(std::string(what) + " is " + in_quotes(text) + ", which no double can hold");
  if (error != std::errc() || end != text.data() + text.size())
    fail(std::string(what) + " should be a number, not " + in_quotes(text));
  if (!std::isfinite(value)) fail(std::string(what) + " is " + in_quotes(text) + ", not finite");
  return value;
}

std::string_view FileReader::line() {
  begin_ = at_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string_view found = bytes_.substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
  return found;
}

bool FileReader::is_at_line_end() {
  while (at_ < bytes_.size() && bytes_[at_] != '\n' && is_space(bytes_[at_])) ++at_;
  return at_ == bytes_.size() || bytes_[at_] == '\n';
}

void FileReader::expect_word(std::string_view expected) {
  const std::string_view found = peek_word();
  if (found.empty())
    fail("the file ends where " + std::string(expected) + " should stand: it is cut off");
  if (found != expected)
    fail(std::string(expected) + " should stand here, not " + in_quotes(found));
  at_ += found.size();
}

void FileReader::begin_binary(bool swaps) {
  if (!is_at_line_end()) fail("nothing may stand before the binary data in its line");
  line();
  is_binary = true;
  swaps_bytes = swaps;
}

std::string_view FileReader::take(std::size_t n, const char* what) {
  begin_ = at_;
  if (n > n_left())
    fail(std::string("the file ends within ") + what + ": " + std::to_string(n) +
         " bytes are needed, " + std::to_string(n_left()) + " are left");
  at_ += n;
  return bytes_.substr(begin_, n);
}

std::size_t FileReader::check_count(std::int64_t n, std::size_t n_bytes_each,
                                    const char* what) const {
  if (n < 0) fail("the number of " + std::string(what) + " is " + std::to_string(n));
  // The last thing of a text may lack its line end.
  const std::size_t n_bytes = n_left() + (is_binary ? 0 : 1);
  if (static_cast<std::size_t>(n) > n_bytes / n_bytes_each)
    fail(std::to_string(n) + " " + what + " are announced, but the file goes on for only " +
         std::to_string(n_left()) + " bytes");
  return static_cast<std::size_t>(n);
}

void FileReader::fail(const std::string& sentence) const {
  if (is_binary) throw InputError(file_ + ": byte " + std::to_string(begin_) + ": " + sentence);
  const std::string_view before = bytes_.substr(0, begin_);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  throw InputError(SourcePlace{file_, static_cast<int>(line), 0}, sentence);
}

void FileReader::fail_file(const std::string& sentence) const {
  throw InputError(file_ + ": " + sentence);
}

}  // namespace trocar
