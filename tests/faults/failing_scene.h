// A run of three frames, each with a checkpoint, whose calls on files fail in the tests, and what
// they ask of it.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "scene_parts.h"
#include "test_files.h"

namespace trocar {

inline constexpr int n_failing_frames = 3;

inline const std::string failing_scene = time_table("0.1 s") + R"([tissue.shape]
kind = "box"
elements = "tet4-kuhn"
high = ["20 mm", "20 mm", "10 mm"]
cells = [2, 2, 1]
)" + tissue_of_kpa(3) + solver_table("-3", 0) +
                                         R"([[support]]
region = "z-"
[checkpoint]
every = "33.4 ms"
[[output]]
kind = "recording"
file = "r.trocar"
)" + metrics_table;

inline std::string digest_in(const std::string& folder) {
  const auto summary = nlohmann::json::parse(read_text(folder + "/summary.json"), nullptr, false);
  return summary.is_object() ? summary.value("state_digest", "none") : "none";
}

// Each is written when its frame is recorded already.
inline std::size_t n_metric_rows(const std::string& folder) {
  const std::string text = read_text(folder + "/m.csv");
  const auto n = std::count(text.begin(), text.end(), '\n');
  return n > 0 ? std::size_t(n) - 1 : 0;
}

// What failing_files.h told of a call.
struct FailedCall {
  std::string call;
  std::string output;  // the file, by the name that the user knows
};

inline FailedCall failed_call(const std::string& line) {
  const std::size_t comma = line.find(", "), of = line.find(" of ");
  FailedCall failed = {.call = line.substr(comma + 2, of - comma - 2),
                       .output = line.substr(of + 4)};
  for (const std::string tail : {"-wal", "-journal", ".new", ".part", "/.trocar-write-test"})
    if (failed.output.ends_with(tail)) failed.output.resize(failed.output.size() - tail.size());
  return failed;
}

// Of what a run said: what the library told, and the run's own sentences.
struct Said {
  std::vector<FailedCall> failed;
  std::string sentences;

  explicit Said(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("failing_files: "))
        failed.push_back(failed_call(line));
      else
        sentences += line + "\n";
  }
  // Whether an error names a file of which a call failed.
  bool names_failed() const {
    const std::size_t at = sentences.find("[error] ");
    return at != sentences.npos && std::ranges::any_of(failed, [&](const FailedCall& one) {
             return sentences.find(one.output, at) != sentences.npos;
           });
  }
};

}  // namespace trocar
