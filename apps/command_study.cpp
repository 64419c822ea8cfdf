#include "apps/command_study.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "apps/write_file.h"
#include "base/log.h"
#include "base/quoted.h"
#include "base/threads.h"
#include "study/study_advice.h"
#include "study/study_page.h"
#include "study/study_plot.h"
#include "study/study_scene.h"
#include "study/study_table.h"
#include "study/study_text.h"

namespace trocar {

namespace {

void print_list() {
  for (const Problem& problem : built_in_problems()) {
    std::string sizes;
    for (const int n : problem.sizes) sizes += (sizes.empty() ? "" : ",") + std::to_string(n);
    std::printf("%-15s %s: %s, sizes %s (%s)\n", problem.name.c_str(), problem.title.c_str(),
                problem.quantity.c_str(), sizes.c_str(), problem.size_meaning.c_str());
  }
}

Problem find_problem(const StudyOptions& options, Communicator& communicator) {
  std::vector<std::string> known;
  for (const Problem& problem : built_in_problems()) {
    if (problem.name == options.subject) return problem;
    known.push_back(problem.name);
  }
  if (std::filesystem::exists(options.subject))
    return problem_of_scene({.scene_file = options.subject,
                             .overrides = options.overrides,
                             .meshes = options.meshes,
                             .sleeps = options.sleeps,
                             .sizes = options.sweep.sizes},
                            communicator);
  if (std::filesystem::path(options.subject).has_extension())
    throw InputError(options.subject + ": there is no file of this name");
  throw InputError(in_quotes(options.subject) + " is neither a scene file nor a built-in problem" +
                   names_hint(options.subject, known));
}

bool has_scene_options(const StudyOptions& options) {
  return !options.meshes.empty() || !options.sleeps.empty() || !options.overrides.empty();
}

// Before the runs, which take minutes. A scene's result is a length, known after its finest run.
void check_target(const StudyOptions& options, const Problem& problem) {
  if (!options.target.empty() && !problem.is_scene)
    require_fits(read_target(options.target), problem);
}

Target target_of(const StudyOptions& options, const Study& study) {
  return options.target.empty() ? median_target(study) : read_target(options.target);
}

void report(const StudyOptions& options, const Study& study) {
  const Problem& problem = study.problem;
  const std::string sentence = advice(study, target_of(options, study));
  const std::string stem = options.folder + "/" + problem.name;
  write_file(stem + ".csv", study_csv(study));
  write_file(stem + ".json", study_json(study, sentence));
  write_file(stem + ".svg", study_svg(study));
  const std::string own = percent_text(problem.reference_error);
  std::printf("%s: %s %s %s, known to %s\n%s\n%s\n", problem.title.c_str(),
              problem.quantity.c_str(), significant(problem.reference, 5).c_str(),
              problem.unit.c_str(), own.c_str(), front_table(study).c_str(), sentence.c_str());
}

void study_all(const StudyOptions& options) {
  for (const Problem& problem : built_in_problems()) check_target(options, problem);
  std::vector<Study> studies;
  for (const Problem& problem : built_in_problems()) {
    log_info(problem.title);
    studies.push_back(sweep(problem, options.sweep));
    report(options, studies.back());
    if (!options.docs.empty())
      write_file(options.docs + "/images/accuracy_" + problem.name + ".svg",
                 study_svg(studies.back()));
  }
  if (!options.docs.empty())
    write_file(options.docs + "/accuracy.md", accuracy_page(studies, "images"));
}

void check_combination(const StudyOptions& options) {
  if (!options.subject.empty() && options.all)
    throw InputError("study: " + in_quotes(options.subject) + " and --all exclude each other");
  if (options.all && has_scene_options(options))
    throw InputError("study: --meshes, --sleep and --set belong to scenes, not to --all");
  if (options.all && !options.sweep.sizes.empty())
    throw InputError("--sizes: what n counts differs between the problems of --all");
  if (!options.docs.empty() && !options.all) throw InputError("study: --docs belongs to --all");
}

}  // namespace

ExitCode command_study(const StudyOptions& options, Communicator& communicator) {
  if (communicator.size() > 1)
    throw InputError("study measures one process with one thread: start it without mpirun");
  check_combination(options);
  if (!options.target.empty()) read_target(options.target);
  set_thread_count(1);
  if (options.list) {
    print_list();
  } else if (options.all) {
    study_all(options);
  } else if (options.subject.empty()) {
    throw InputError("study: name a problem (trocar study --list), a scene file, or --all");
  } else {
    const Problem problem = find_problem(options, communicator);
    if (has_scene_options(options) && !problem.is_scene)
      throw InputError("--meshes, --sleep and --set belong to scenes, not to " + problem.name);
    check_target(options, problem);
    report(options, sweep(problem, options.sweep));
  }
  return ExitCode::done;
}

}  // namespace trocar
