// Places of keys once the file is read, and the errors of a file as one.
#include <algorithm>
#include <tuple>

#include "base/options_node.h"

namespace trocar {

// "support[1].path[0].time" -> "support[1]"
static std::string top_of(const std::string& key_path) {
  return key_path.substr(0, key_path.find('.'));
}

SourcePlace SourceMap::find(const std::string& key_path) const {
  std::string path = key_path;
  while (!path.empty()) {
    const auto found = places.find(path);
    if (found != places.end()) return found->second;
    const std::size_t end = path.find_last_of(".[");
    path.resize(end == std::string::npos ? 0 : end);
  }
  return {file, 1, 1};
}

std::string SourceMap::message(const std::string& key_path, const std::string& sentence) const {
  const SourcePlace place = find(key_path);
  const bool is_in_file = place.file == file && places.contains(top_of(key_path));
  const std::string lines = is_in_file ? excerpt(text, place.line, place.column) : "";
  return InputError(place, key_path + ": " + sentence + lines).what();
}

void SourceMap::fail(const std::string& key_path, const std::string& sentence) const {
  throw InputError(message(key_path, sentence));
}

void OptionErrors::add(OptionError error) {
  ++n_;
  if (is_full()) return;
  unread_tables_.insert(top_of(error.key_path));
  shown_.push_back(std::move(error));
}

void OptionErrors::add(const std::string& key_path, const std::string& sentence) {
  if (unread_tables_.contains(top_of(key_path)) || !wrong_keys_.insert(key_path).second) return;
  ++n_;
  if (is_full()) return;
  const SourcePlace place = where_->find(key_path);
  shown_.push_back({.source = place.file == where_->file ? 0 : 1,
                    .line = place.line,
                    .column = place.column,
                    .key_path = key_path,
                    .message = where_->message(key_path, sentence)});
}

void OptionErrors::add_at_first(std::initializer_list<std::string> key_paths,
                                const std::string& sentence) {
  const auto* const given = std::ranges::find_if(
      key_paths, [&](const std::string& path) { return where_->places.contains(path); });
  add(given != key_paths.end() ? *given : *(key_paths.end() - 1), sentence);
}

void OptionErrors::throw_if_any() const {
  if (is_empty()) return;
  std::vector<OptionError> sorted = shown_;
  std::ranges::stable_sort(sorted, {}, [](const OptionError& error) {
    return std::tie(error.source, error.line, error.column);
  });
  std::string text;
  for (const OptionError& error : sorted)
    text.append(text.empty() ? "" : "\n").append(error.message);
  const std::size_t n_hidden = n_ - shown_.size();
  if (n_hidden > 0) text.append("\n… and ").append(std::to_string(n_hidden)).append(" more errors");
  throw InputError(text);
}

}  // namespace trocar
