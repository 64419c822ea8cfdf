#include "study/study_advice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/quoted.h"
#include "base/units.h"
#include "study/study_text.h"

namespace trocar {

namespace {

// Costs within this factor are the same: so much do two runs of one case differ at least.
constexpr double scatter = 1.05;

// Errors within this factor are the same.
constexpr double same_error = 1.01;

// Whether the times of two runs, each from the least to the median of its repetitions, overlap or
// lie within the scatter: what disturbs a timing makes it longer, and the longest may be disturbed
// without bounds.
bool are_as_fast(const Run& a, const Run& b) {
  const auto most = [](const Run& run) { return run.outcome.stepping_seconds; };
  const auto least = [&](const Run& run) {
    const double of_repetitions = run.outcome.least_stepping_seconds;
    return of_repetitions > 0 ? of_repetitions : most(run);
  };
  return least(a) <= scatter * most(b) && least(b) <= scatter * most(a);
}

bool counts(const Run& run) {
  return is_sound(run) && !run.is_reference;
}

double error_as(const Run& run, const Target& target) {
  return target.is_length ? run.error_length : run.error;
}

std::string error_text(const Target& target, double error) {
  return target.is_length ? length_text(error) : percent_text(error);
}

std::string cost_text(const Study& study, const Run& run) {
  if (study.problem.is_static())
    return seconds_text(run.outcome.stepping_seconds) + " of processor time";
  return seconds_text(cost_of(study, run)) + " of processor time a simulated second";
}

std::string run_text(const Study& study, const Target& target, const Run& run) {
  std::string text = case_text(run) + " (h = " + length_text(run.outcome.h);
  if (run.outcome.dt > 0) text += ", dt = " + seconds_text(run.outcome.dt);
  return text + "): " + (run.is_at_reference ? "at most " : "") +
         error_text(target, error_as(run, target)) + " for " + cost_text(study, run);
}

// A run of another method beside the best one, which the figures may not tell from it.
std::string next_text(const Study& study, const Target& target, const Run& best, const Run& next) {
  return (are_as_fast(best, next) ? "; as fast within the noise of the timing is "
                                  : "; next best is ") +
         run_text(study, target, next);
}

const Run* nearest_run(const Study& study) {
  const Run* nearest = nullptr;
  for (const Run& run : study.runs)
    if (counts(run) && (nearest == nullptr || run.error < nearest->error)) nearest = &run;
  return nearest;
}

}  // namespace

Target read_target(const std::string& text) {
  const bool is_length = text.find('%') == std::string::npos;
  try {
    const double error = parse_quantity(text, is_length ? dim::length : dim::none);
    if (!(error > 0) || !std::isfinite(error)) throw std::invalid_argument("it must be above 0");
    return {.error = error, .is_length = is_length};
  } catch (const std::invalid_argument& trouble) {
    throw InputError("--target: " + in_quotes(text) +
                     " is neither a length such as \"1 mm\" nor a " + "share such as \"1 %\" (" +
                     trouble.what() + ")");
  }
}

void require_fits(const Target& target, const Problem& problem) {
  if (target.is_length && problem.length == 0)
    throw InputError("--target: the result of " + problem.name + ", its " + problem.quantity +
                     ", is no length; give a share such as \"1 %\"");
}

Target median_target(const Study& study) {
  std::vector<double> errors;
  for (const Run* run : pareto_front(study)) errors.push_back(run->error);
  if (errors.empty()) return {.error = study.problem.reference_error};
  std::sort(errors.begin(), errors.end());
  const bool is_length = study.problem.length > 0;
  // A little more than the run's own error: it would shut out its equals that are cheaper.
  const double median = 1.1 * errors[(errors.size() - 1) / 2];
  return {.error = is_length ? median * study.problem.length : median, .is_length = is_length};
}

const Run* cheapest_within(const Study& study, const Target& target,
                           const std::string& other_than) {
  std::vector<const Run*> candidates;
  for (const Run& run : study.runs)
    if (counts(run) && error_as(run, target) <= target.error &&
        (other_than.empty() || method_text(run) != other_than))
      candidates.push_back(&run);
  if (candidates.empty()) return nullptr;
  const auto cost = [&](const Run* run) { return cost_of(study, *run); };
  const Run* cheapest = *std::ranges::min_element(candidates, {}, cost);
  std::erase_if(candidates, [&](const Run* run) { return !are_as_fast(*run, *cheapest); });
  const double least = (*std::ranges::min_element(candidates, {}, &Run::error))->error;
  std::erase_if(candidates, [&](const Run* run) { return run->error > same_error * least; });
  return *std::ranges::min_element(candidates, {}, cost);
}

std::vector<const Run*> pareto_front(const Study& study) {
  std::vector<const Run*> front;
  for (const Run& run : study.runs)
    if (counts(run)) front.push_back(&run);
  std::stable_sort(front.begin(), front.end(), [&](const Run* a, const Run* b) {
    return cost_of(study, *a) < cost_of(study, *b);
  });
  double least = std::numeric_limits<double>::infinity();
  std::erase_if(front, [&](const Run* run) {
    const bool is_beaten = run->error >= least;
    least = std::min(least, run->error);
    return is_beaten;
  });
  return front;
}

std::string advice(const Study& study, const Target& target) {
  require_fits(target, study.problem);
  const Run* best = cheapest_within(study, target);
  const Run* nearest = nearest_run(study);
  if (nearest == nullptr) return "No run of this sweep can be rated.";
  const std::string goal = error_text(target, target.error);
  if (best == nullptr)
    return "No run of this sweep is within " + goal + "; the nearest is " +
           run_text(study, target, *nearest) + ".";
  std::string text = "For " + goal + " error at least cost use " + run_text(study, target, *best);
  if (const Run* next = cheapest_within(study, target, method_text(*best)))
    text += next_text(study, target, *best, *next);
  return text + ".";
}

}  // namespace trocar
