#include "apps/command_cut2d.h"

#include <cstdio>

#include "apps/read_scale.h"
#include "apps/write_file.h"
#include "base/box.h"
#include "base/log.h"
#include "cutting/cut_plane_paper.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "study/cut2d_json.h"
#include "study/cut2d_path.h"
#include "study/cut2d_picture.h"
#include "study/cut2d_sweep_page.h"
#include "study/cut2d_table.h"

namespace trocar {

namespace {

Cut2dMode mode_of(const std::string& name) {
  return name == "paper" ? Cut2dMode::paper
         : name == "or"  ? Cut2dMode::subdivision
                         : Cut2dMode::robust;
}

Mesh mesh_of(const Cut2dCommand& command) {
  if (command.configuration > 0) return paper_mesh(command.configuration);
  const std::string scale = command.mesh_scale.empty() ? "1 mm" : command.mesh_scale;
  Mesh mesh = read_mesh(command.mesh_file, read_scale(scale));
  if (mesh.dimension() != 2)
    throw InputError(command.mesh_file +
                     ": cut2d needs a mesh of triangles in a plane z = const, nothing else");
  return mesh;
}

std::vector<Cut2dPath> paths_of(const Cut2dCommand& command) {
  std::vector<Cut2dPath> paths;
  for (const std::string& text : command.paths) paths.push_back(read_path(text));
  for (const std::string& text : command.arcs) paths.push_back(read_arc(text));
  if (!paths.empty()) return paths;
  if (command.configuration == 0) throw InputError("cut2d: say where to cut with --path or --arc");
  return {paper_cut(command.configuration)};
}

void draw_trial(const Cut2dCommand& command, const std::string& stem, const Cut2dTrial& trial) {
  if (command.svg_folder.empty()) return;
  const std::string file = command.svg_folder + "/" + stem;
  write_file(file + "before.svg", mesh_svg(trial.before, trial.paths, "Before the cut"));
  write_file(file + "after_" + command.mode + ".svg",
             mesh_svg(trial.after, {}, "After the cut, mode " + command.mode));
}

void print_trial(const Cut2dTrial& trial, Cut2dMode mode) {
  std::printf(
      "%s\n%d edges opened, %d nodes and %d elements new, %d nodes moved, %d parts of the path "
      "refused\n"
      "stable step after / before %.3f, least altitude %.3f; cut nodes off the path by at most "
      "%.3g "
      "mm\n",
      rows_text({{0, "I", "before", trial.statistics_before, 0, 0, ""},
                 {0, mode == Cut2dMode::subdivision ? "OR" : "NR", "after", trial.statistics_after,
                  trial.best_seconds, trial.median_seconds, ""}})
          .c_str(),
      trial.figures.n_opened_facets, trial.n_new_nodes, trial.n_new_elements, trial.figures.n_moved,
      trial.figures.n_refused, trial.step_ratio, trial.altitude_ratio,
      1e3 * trial.figures.largest_deviation);
  for (const CutRefusal& refusal : trial.figures.refusals)
    std::printf("stays joined at %.4g,%.4g mm: %s\n", 1e3 * refusal.X.x(), 1e3 * refusal.X.y(),
                reason_of(refusal));
}

std::string nothing_cut_text(const Cut2dTrial& trial) {
  if (!trial.figures.refusals.empty())
    return "nothing was cut: what the path crosses stays joined, for the reasons that are told";
  const auto [low, high] = bounding_box(trial.before.X);
  char text[200];
  std::snprintf(
      text, sizeof text,
      "nothing was cut: the path misses the mesh, which lies from %.4g,%.4g to %.4g,%.4g mm, or "
      "is too short for it",
      1e3 * low.x(), 1e3 * low.y(), 1e3 * high.x(), 1e3 * high.y());
  return text;
}

ExitCode cut_one(const Cut2dCommand& command) {
  const Cut2dTrial trial =
      run_trial(mesh_of(command), paths_of(command),
                options_of(mode_of(command.mode), command.repetitions, command.least_step_ratio));
  draw_trial(command, "", trial);
  if (trial.figures.n_opened_facets == 0) log_warning(nothing_cut_text(trial));
  if (command.is_json)
    std::fputs(trial_json(trial, command.mode).c_str(), stdout);
  else
    print_trial(trial, mode_of(command.mode));
  return ExitCode::done;
}

constexpr const char* below_table =
    "\nOR: a node at every intersection. NR: nodes displaced; times of the paper on an SGI Octane, "
    "195 MHz. # differs from the\nprinted digits. Where the paper cut is not known: the cuts here "
    "reproduce all counts and, for 1 and 2, the rows OR. Its\nmeshes 5 and 6 are not known either: "
    "ours are graded meshes with the same counts and mean areas.\n";

// Pictures in the style of the paper's figures, one set a configuration.
void draw_table(const Cut2dCommand& command) {
  for (int c = 1; c <= n_paper_configurations; ++c)
    for (const char* mode : {"or", "paper", "robust"}) {
      Cut2dCommand one = command;
      one.mode = mode;
      draw_trial(one, "configuration_" + std::to_string(c) + "_",
                 run_trial(paper_mesh(c), {paper_cut(c)}, options_of(mode_of(mode), 1)));
    }
}

ExitCode print_table(const Cut2dCommand& command) {
  const std::vector<Cut2dRow> rows = paper_rows(command.repetitions);
  if (!command.svg_folder.empty()) draw_table(command);
  if (!command.markdown_file.empty())
    write_file(command.markdown_file,
               "# Table 1 of Serby, Harders and Szekely (2001), printed and computed\n\n"
               "Written by `trocar cut2d --table1 --markdown FILE`.\n\n" +
                   rows_markdown(rows) + below_table);
  if (command.is_json)
    std::fputs(rows_json(rows).c_str(), stdout);
  else
    std::printf("%s%s", rows_text(rows).c_str(), below_table);
  return ExitCode::done;
}

ExitCode sweep_parameters(const Cut2dCommand& command) {
  std::vector<Cut2dParameter> parameters = cut2d_parameters();
  for (Cut2dParameter& parameter : parameters) {
    sample_parameter(parameter, command.n_cuts);
    std::printf("%s\n", parameter_section(parameter).c_str());
    if (!command.docs_folder.empty())
      write_file(command.docs_folder + "/images/" + parameter_file(parameter),
                 parameter_svg(parameter));
  }
  if (!command.docs_folder.empty())
    write_file(command.docs_folder + "/cutting-parameters.md",
               sweep_page(parameters, command.n_cuts));
  return ExitCode::done;
}

// What the pairs of options that the command line refuses leave to be said.
void check_mesh(const Cut2dCommand& command) {
  const bool has_mesh = command.configuration > 0 || !command.mesh_file.empty();
  if (!command.mesh_scale.empty() && command.mesh_file.empty())
    throw InputError("cut2d: --scale belongs to --mesh: the paper's meshes have their own size");
  if (!command.is_table && !command.is_sweep && !has_mesh)
    throw InputError("cut2d: name a mesh with --config or --mesh, or ask for --table1 or --sweep");
}

}  // namespace

ExitCode command_cut2d(const Cut2dCommand& command) {
  check_mesh(command);
  if (command.is_sweep) return sweep_parameters(command);
  return command.is_table ? print_table(command) : cut_one(command);
}

}  // namespace trocar
