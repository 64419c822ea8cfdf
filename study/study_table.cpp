#include "study/study_table.h"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/quoted.h"
#include "engine/version.h"

namespace trocar {

namespace {

using Json = nlohmann::ordered_json;

// The columns, once for both forms. null where a run has none.
Json row_of(const Study& study, const Run& run) {
  const Outcome& o = run.outcome;
  const bool is_good = is_sound(run), is_static = study.problem.is_static();
  const auto if_good = [&](const Json& value) { return is_good ? value : Json(); };
  const bool has_value = is_good && !study.problem.is_scene;
  Json row;
  row["elements"] = run.method;
  row["precision"] = run.precision;
  row["step_factor"] = is_static ? Json() : Json(run.step_factor);
  row["sleep_m"] = study.problem.is_scene ? Json(run.sleep) : Json();
  row["size"] = run.size;
  row["h_m"] = o.h;
  row["dt_s"] = is_static ? Json() : Json(o.dt);
  row["n_elements"] = o.n_elements;
  row["n_steps"] = o.n_steps;
  row["element_steps"] = element_steps(run);
  row["setup_cpu_s"] = o.setup_seconds;
  row["stepping_cpu_s"] = o.stepping_seconds;
  row["least_stepping_cpu_s"] =
      o.least_stepping_seconds > 0 ? Json(o.least_stepping_seconds) : Json();
  row["cpu_s_per_simulated_s"] = is_static ? Json() : if_good(cost_of(study, run));
  row["ns_per_element_step"] = if_good(1e9 * o.stepping_seconds / element_steps(run));
  row["value"] = has_value ? Json(o.value) : Json();
  row["relative_error"] = if_good(run.error);
  row["error_m"] = study.problem.length > 0 ? if_good(run.error_length) : Json();
  row["is_below_reference_error"] = if_good(run.is_at_reference);
  row["is_reference"] = run.is_reference;
  row["trouble"] = is_good ? Json() : Json(o.trouble);
  return row;
}

std::string csv_cell(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? csv_quoted(value.get<std::string>()) : value.dump();
}

Json head_of(const Problem& problem) {
  return {{"name", problem.name},
          {"title", problem.title},
          {"quantity", problem.quantity},
          {"unit", problem.unit},
          {"reference", problem.reference},
          {"reference_relative_error", problem.reference_error},
          {"reference_source", problem.is_scene ? "finest run of the sweep" : problem.source},
          {"simulated_s", problem.simulated_seconds},
          {"size_meaning", problem.size_meaning}};
}

}  // namespace

std::string study_csv(const Study& study) {
  std::string text;
  for (const Run& run : study.runs) {
    const Json row = row_of(study, run);
    std::string names, cells;
    for (const auto& [name, value] : row.items()) {
      names += (names.empty() ? "" : ",") + name;
      cells += (cells.empty() ? "" : ",") + csv_cell(value);
    }
    if (text.empty()) text = names + "\n";
    text += cells + "\n";
  }
  return text;
}

std::string study_json(const Study& study, const std::string& advice) {
  Json runs = Json::array();
  for (const Run& run : study.runs) runs.push_back(row_of(study, run));
  const Json all = {{"program", version_text()},
                    {"problem", head_of(study.problem)},
                    {"advice", advice},
                    {"notes", study.notes},
                    {"runs", runs}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace trocar
