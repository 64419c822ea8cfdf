#include "study/study_page.h"

#include "solver/step.h"
#include "study/study_advice.h"
#include "study/study_text.h"

namespace trocar {

namespace {

std::string front_row(const Study& study, const Run& run) {
  const Problem& problem = study.problem;
  const Outcome& o = run.outcome;
  std::string row = "| " + method_text(run) + " | " + run.size + " | " + length_text(o.h) + " | ";
  if (!problem.is_static()) row += seconds_text(o.dt) + " | ";
  row += (run.is_at_reference ? "<= " : "") + percent_text(run.error) + " | ";
  if (problem.length > 0) row += length_text(run.error_length) + " | ";
  return row + seconds_text(cost_of(study, run)) + " | " + seconds_text(o.setup_seconds) + " | " +
         significant(element_steps(run), 3) + " | " +
         significant(1e9 * o.stepping_seconds / element_steps(run), 2) + " |\n";
}

std::string reference_text(const Problem& problem) {
  std::string text = "Reference: " + problem.quantity + " " + significant(problem.reference, 5) +
                     " " + problem.unit + ", " + problem.source;
  if (problem.reference_error > 0)
    text += ", known to " + percent_text(problem.reference_error) +
            "; smaller differences are shown as that";
  return text + ". n: " + problem.size_meaning + ".";
}

std::string section(const Study& study, const std::string& image_folder) {
  const Problem& problem = study.problem;
  std::string text = "\n## " + problem.title + "\n\n" + reference_text(problem) +
                     "\n\n![Error of the " + problem.quantity + " against run time](" +
                     image_folder + "/accuracy_" + problem.name + ".svg)\n\n" + front_table(study) +
                     "\n" + advice(study, median_target(study)) + "\n";
  if (const Run* run = cheapest_within(study, {.error = .01}); run != nullptr)
    text += "\n" + advice(study, {.error = .01}) + "\n";
  return text;
}

constexpr const char* page_head =
    "# Run time against error\n\n"
    "Made by `scripts/accuracy`, which runs `trocar study --all --docs docs`. Each problem is "
    "computed with every element, in double and single precision, with several sizes of cells and "
    "(where something moves in time) two time steps; `trocar study --help` says how to choose "
    "others, or a scene of your own instead.\n\n"
    "- Cost is processor time of one thread while stepping, searches for the stable step included; "
    "set-up is apart. Runs below 0.3 s are repeated three times and the median is kept; runs whose "
    "times, from the least to the median, overlap or differ by less than 5 % are as fast within "
    "the noise, and of these the more accurate one is advised.\n"
    "- An element-step is one element in one step: a cost that no machine changes.\n"
    "- The step factor is the time step over the stable step of the body's highest frequency. "
    "Steady states are found by dynamic relaxation, which chooses its own steps.\n"
    "- Tables show the runs that no other beats in both error and cost (filled points of the "
    "plots; hollow ones are beaten). Curves can cross zero error between two sizes: a single small "
    "error is no proof, a falling curve is.\n";

}  // namespace

std::string front_table(const Study& study) {
  const Problem& problem = study.problem;
  std::string names = "| method | size | h | ", rule = "|---|---|---|";
  const auto column = [&](const char* name) {
    names += std::string(name) + " | ";
    rule += "---|";
  };
  if (!problem.is_static()) column("dt");
  column("relative error");
  if (problem.length > 0) column("error");
  column(problem.is_static() ? "cost" : "cost a simulated second");
  for (const char* name : {"set-up", "element-steps", "ns an element-step"}) column(name);
  names.pop_back();
  std::string text = names + "\n" + rule + "\n";
  for (const Run* run : pareto_front(study)) text += front_row(study, *run);
  return text;
}

std::string accuracy_page(const std::vector<Study>& studies, const std::string& image_folder) {
  std::string text = page_head;
  text += std::string("- Kernels of this page: ") + simd_name() +
          ", one thread. Times depend on the machine and on what else it does: compare ratios.\n";
  for (const Study& study : studies) text += section(study, image_folder);
  return text;
}

}  // namespace trocar
