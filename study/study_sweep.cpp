#include "study/study_sweep.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <new>

#include "base/error.h"
#include "base/log.h"
#include "base/quantile.h"
#include "base/timers.h"
#include "study/study_body.h"
#include "study/study_text.h"

namespace trocar {

namespace {

// Cases of one curve: everything but the size.
struct CurveCases {
  Method method;
  Precision precision;
  double step_factor, sleep;
};

std::vector<Method> wanted_methods(const Problem& problem, const SweepOptions& options) {
  if (options.elements.empty()) return problem.methods;
  std::vector<Method> wanted;
  for (const std::string& name : options.elements) {
    const Method& method = method_named(name);
    const auto is_it = [&](const Method& m) { return m.formulation == method.formulation; };
    if (std::none_of(problem.methods.begin(), problem.methods.end(), is_it))
      throw InputError("--elements: " + name + " can't compute " + problem.name);
    wanted.push_back(method);
  }
  return wanted;
}

// Coarse ones first.
std::vector<int> wanted_sizes(const Problem& problem, const SweepOptions& options) {
  std::vector<int> sizes = options.sizes.empty() ? problem.sizes : options.sizes;
  for (const int n : sizes)
    if (n % problem.size_multiple != 0)
      throw InputError("--sizes: " + problem.name + " takes multiples of " +
                       std::to_string(problem.size_multiple) + ", " + problem.size_meaning +
                       "; got " + std::to_string(n));
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

std::vector<CurveCases> curves_of(const Problem& problem, const SweepOptions& options) {
  std::vector<Precision> precisions;
  for (const std::string& name : options.precisions) precisions.push_back(precision_named(name));
  if (precisions.empty()) precisions = {Precision::in_double, Precision::in_single};
  const bool has_factors = !problem.is_static() && !options.step_factors.empty();
  const std::vector<double>& factors = has_factors ? options.step_factors : problem.factors;
  std::vector<CurveCases> curves;
  for (const Method& method : wanted_methods(problem, options))
    for (const Precision precision : precisions)
      for (const double factor : factors)
        for (const double sleep : problem.sleeps)
          curves.push_back({method, precision, factor, sleep});
  return curves;
}

double seconds_of(const Outcome& outcome) {
  return outcome.setup_seconds + outcome.stepping_seconds;
}

// Short runs are repeated, and median and least of their times are kept.
Outcome solve_repeatedly(const Problem& problem, const Case& c, int repeats) {
  Outcome outcome = problem.solve(c);
  if (outcome.stepping_seconds > short_run) return outcome;
  std::vector<double> seconds = {outcome.stepping_seconds};
  for (int k = 1; k < repeats; ++k) seconds.push_back(problem.solve(c).stepping_seconds);
  outcome.stepping_seconds = quantile(seconds, 0.5);
  if (seconds.size() > 1) outcome.least_stepping_seconds = quantile(seconds, 0);
  return outcome;
}

Run run_of(const Problem& problem, const CurveCases& curve, int n) {
  return {.method = curve.method.name,
          .precision = name_of(curve.precision),
          .size = problem.size_label ? problem.size_label(n) : "n = " + std::to_string(n),
          .step_factor = problem.is_static() ? 0 : curve.step_factor,
          .sleep = curve.sleep,
          .n = n};
}

Run run_case(const Problem& problem, const CurveCases& curve, int n, int repeats) {
  Run run = run_of(problem, curve, n);
  run.outcome = solve_repeatedly(
      problem, {curve.method, curve.precision, curve.step_factor, n, curve.sleep}, repeats);
  return run;
}

// A size that can't be built, too many nodes or too much memory, is no reason to lose what has been
// computed; the first one is.
Run run_or_note(const Study& study, const CurveCases& curve, int n, int repeats) {
  const auto note = [&](const std::string& trouble) {
    if (std::ranges::none_of(study.runs, is_sound)) throw;
    Run run = run_of(study.problem, curve, n);
    run.outcome.trouble = trouble.substr(0, trouble.find('\n'));
    return run;
  };
  try {
    return run_case(study.problem, curve, n, repeats);
  } catch (const InputError& trouble) {
    return note(trouble.what());
  } catch (const std::bad_alloc&) {
    return note("not enough memory");
  }
}

// What the curve's last run says about the next size; 0 if there is none.
double predicted_seconds(const Problem& problem, const Run* before, int n) {
  if (before == nullptr) return 0;
  const double ratio = problem.edges.empty() ? static_cast<double>(n) / before->n
                                             : problem.edges[before->n - 1] / problem.edges[n - 1];
  return seconds_of(before->outcome) * std::pow(ratio, problem.growth);
}

void tell(const Run& run) {
  log_info(case_text(run) + ": " +
           (run.outcome.trouble.empty() ? significant(run.outcome.stepping_seconds, 3) + " s for " +
                                              significant(element_steps(run), 3) + " element-steps"
                                        : run.outcome.trouble));
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, (a[k] - b[k]).norm());
  return most;
}

// What is left between a run and its own method's limit, as if it fell with the first power of the
// edge: what refinement from the next coarser mesh changed, over the ratio of the edges less one.
// Infinite if there is no coarser run. [m]
double own_error(const std::vector<Run>& runs, const Run& run) {
  const Run* next = nullptr;
  for (const Run& other : runs)
    if (is_sound(other) && method_text(other) == method_text(run) && other.n < run.n &&
        (next == nullptr || other.n > next->n))
      next = &other;
  const double ratio = next == nullptr ? 1 : next->outcome.h / run.outcome.h;
  if (!(ratio > 1)) return std::numeric_limits<double>::infinity();
  return largest_difference(next->outcome.samples, run.outcome.samples) / (ratio - 1);
}

// Of the runs with the finest mesh the one with the least error of its own: elements that lock are
// still on their way.
Run* finest_run(std::vector<Run>& runs) {
  const auto key = [&](const Run& run) { return std::pair(-run.n, own_error(runs, run)); };
  Run* finest = nullptr;
  for (Run& run : runs)
    if (is_sound(run) && (finest == nullptr || key(run) < key(*finest))) finest = &run;
  return finest;
}

void rate_scene(Study& study) {
  Run* finest = finest_run(study.runs);
  if (finest == nullptr) return;
  finest->is_reference = true;
  Problem& problem = study.problem;
  if (!std::isfinite(own_error(study.runs, *finest)))
    study.notes.push_back("the reference's own error is unknown: it needs a second, coarser size");
  const std::vector<Vec3> rest(finest->outcome.samples.size(), Vec3::Zero());
  problem.length = problem.reference = largest_difference(finest->outcome.samples, rest);
  if (problem.length == 0)
    throw InputError(problem.name +
                     ": nothing moves in this scene, so that its runs can't be compared");
  problem.reference_error = std::min(1., own_error(study.runs, *finest) / problem.length);
  for (Run& run : study.runs)
    if (is_sound(run))
      run.error = largest_difference(run.outcome.samples, finest->outcome.samples) / problem.length;
}

// What sleep alone changed, run by run: meshes differ by more than that.
void note_sleep(Study& study) {
  for (const Run& run : study.runs)
    for (const Run& awake : study.runs) {
      const bool is_twin = run.sleep > 0 && awake.sleep == 0 && awake.method == run.method &&
                           awake.precision == run.precision && awake.n == run.n &&
                           awake.step_factor == run.step_factor;
      if (!is_twin || !is_sound(run) || !is_sound(awake)) continue;
      study.notes.push_back(
          case_text(run) + ": at most " +
          length_text(largest_difference(run.outcome.samples, awake.outcome.samples)) +
          " from the same run without sleep, " + significant(cost_of(study, run), 3) +
          " s a simulated second instead of " + significant(cost_of(study, awake), 3) + " s");
      log_info(study.notes.back());
    }
}

}  // namespace

void rate(Study& study) {
  const Problem& problem = study.problem;
  if (problem.is_scene) {
    rate_scene(study);
    note_sleep(study);
  } else {
    for (Run& run : study.runs) run.error = std::abs(run.outcome.value / problem.reference - 1);
  }
  for (Run& run : study.runs) {
    if (!is_sound(run)) run.error = std::numeric_limits<double>::infinity();
    run.is_at_reference = run.error < problem.reference_error;
    run.error = std::max(run.error, problem.reference_error);
    run.error_length = problem.length > 0 ? run.error * problem.length : 0;
  }
}

Study sweep(const Problem& problem, const SweepOptions& options) {
  Study study{.problem = problem};
  const std::vector<int> sizes = wanted_sizes(problem, options);
  const std::vector<CurveCases> curves = curves_of(problem, options);
  std::map<std::size_t, Run> last;  // of each curve
  double left = options.budget;
  for (const int n : sizes)
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const double start = thread_seconds();
      const auto before = last.find(k);
      const double expected =
          predicted_seconds(problem, before == last.end() ? nullptr : &before->second, n);
      if (expected > left || left <= 0) {
        study.notes.push_back(case_text(run_of(problem, curves[k], n)) + " left out: about " +
                              significant(expected, 2) + " s, of the budget " +
                              significant(std::max(left, 0.), 2) + " s are left");
        log_info(study.notes.back());
        continue;
      }
      study.runs.push_back(run_or_note(study, curves[k], n, options.repeats));
      tell(study.runs.back());
      if (seconds_of(study.runs.back().outcome) > 0) last[k] = study.runs.back();
      left -= thread_seconds() - start;
    }
  rate(study);
  return study;
}

bool is_sound(const Run& run) {
  return run.outcome.trouble.empty();
}

std::string method_text(const Run& run) {
  std::string text = run.method + " " + run.precision;
  if (run.step_factor > 0) text += ", step factor " + significant(run.step_factor, 3);
  if (run.sleep > 0) text += ", sleep " + length_text(run.sleep);
  return text;
}

std::string case_text(const Run& run) {
  return method_text(run) + ", " + run.size;
}

double cost_of(const Study& study, const Run& run) {
  const Outcome& outcome = run.outcome;
  if (study.problem.is_static()) return outcome.stepping_seconds;
  return outcome.stepping_seconds / (outcome.dt * static_cast<double>(outcome.n_steps));
}

double element_steps(const Run& run) {
  return static_cast<double>(run.outcome.n_elements) * static_cast<double>(run.outcome.n_steps);
}

}  // namespace trocar
