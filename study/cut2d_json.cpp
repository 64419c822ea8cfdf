#include "study/cut2d_json.h"

#include <nlohmann/json.hpp>

namespace trocar {

namespace {

using Json = nlohmann::ordered_json;

Json spread_json(const Spread& s) {
  return {{"min", s.min}, {"max", s.max}, {"mean", s.mean}, {"sigma", s.sigma}};
}

Json statistics_json(const PlaneStatistics& s) {
  return {{"n_nodes", s.n_nodes},
          {"n_elements", s.n_elements},
          {"area_mm2", spread_json(s.area)},
          {"edge_mm", spread_json(s.edge)}};
}

}  // namespace

std::string trial_json(const Cut2dTrial& trial, const std::string& mode) {
  Json json;
  json["mode"] = mode;
  json["before"] = statistics_json(trial.statistics_before);
  json["after"] = statistics_json(trial.statistics_after);
  json["n_opened_edges"] = trial.figures.n_opened_facets;
  json["n_new_nodes"] = trial.n_new_nodes;
  json["n_new_elements"] = trial.n_new_elements;
  json["n_moved_nodes"] = trial.figures.n_moved;
  json["n_refused"] = trial.figures.n_refused;
  json["refusals"] = Json::array();
  for (const CutRefusal& refusal : trial.figures.refusals)
    json["refusals"].push_back(
        {{"X_m", {refusal.X.x(), refusal.X.y(), 0}}, {"reason", reason_of(refusal)}});
  json["largest_deviation_m"] = trial.figures.largest_deviation;
  json["least_altitude_ratio"] = trial.altitude_ratio;
  json["least_step_ratio"] = trial.step_ratio;
  json["best_s"] = trial.best_seconds;
  json["median_s"] = trial.median_seconds;
  return json.dump(2) + "\n";
}

std::string rows_json(const std::vector<Cut2dRow>& rows) {
  Json json = Json::array();
  for (const Cut2dRow& row : rows) {
    Json one = {{"configuration", row.configuration}, {"mesh", row.kind}, {"from", row.source}};
    one.update(statistics_json(row.statistics));
    one["best_s"] = row.best_seconds > 0 ? Json(row.best_seconds) : Json();
    one["median_s"] = row.median_seconds > 0 ? Json(row.median_seconds) : Json();
    one["note"] = row.note;
    json.push_back(one);
  }
  return json.dump(2) + "\n";
}

}  // namespace trocar
