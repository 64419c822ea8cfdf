#include "study/study_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/sort_unique.h"
#include "base/timers.h"
#include "engine/build.h"
#include "engine/equilibrium.h"
#include "engine/frame.h"
#include "engine/tissue.h"
#include "mesh/partition.h"
#include "mesh/quality.h"
#include "solver/element_setup.h"
#include "study/study_body.h"
#include "study/study_interpolate.h"

namespace trocar {

namespace {

constexpr int n_sample_times = 5;
constexpr std::size_t most_sample_points = 400;

// What all runs share.
struct SceneStudy {
  LoadedScene loaded;  // without outputs
  Communicator* communicator = nullptr;
  std::vector<std::string> meshes;
  std::vector<Vec3> points;

  bool has_shape() const { return loaded.scene.tissue.shape.has_value(); }
  std::int64_t n_frames() const { return loaded.scene.time.n_frames(); }
};

// What the kind of shape takes of `cells`: for each the least that makes a mesh, 0: it is not used.
// (Nodes of rectangles.)
std::array<int, 3> least_cells(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::box:
      return {1, 1, 1};
    case ShapeKind::ball:
      return {2, 0, 0};
    case ShapeKind::cylinder:
      return {2, 0, 1};
    case ShapeKind::rectangle:
      return {2, 2, 0};
    case ShapeKind::triangular_rectangle:
      return {3, 2, 0};
  }
  return {1, 1, 1};
}

int most_cells(const SceneShape& shape) {
  const std::array<int, 3> least = least_cells(shape.kind);
  int most = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (least[k] > 0) most = std::max(most, shape.cells[k]);
  return most;
}

// n cells where the scene has most, the others in proportion.
void scale_cells(int n, SceneShape& shape) {
  const double ratio = static_cast<double>(n) / most_cells(shape);
  const std::array<int, 3> least = least_cells(shape.kind);
  for (std::size_t k = 0; k < 3; ++k)
    shape.cells[k] = std::max({1, least[k], static_cast<int>(std::lround(ratio * shape.cells[k]))});
}

LoadedScene scene_of(const SceneStudy& study, const Case& c) {
  LoadedScene loaded = study.loaded;
  SceneTissue& tissue = loaded.scene.tissue;
  SceneSolver& solver = loaded.scene.solver;
  solver.step_factor = c.step_factor;
  solver.sleep = c.sleep;
  solver.precision = c.precision;
  of_shape(shape_of(c.method.formulation), solver.triangle, solver.tetrahedron, solver.hexahedron) =
      c.method.formulation;
  if (!study.has_shape()) {
    if (!study.meshes.empty()) tissue.mesh = study.meshes[c.n - 1];
    return loaded;
  }
  scale_cells(c.n, *tissue.shape);
  // Tetrahedra stay those of the scene.
  BoxElements& elements = tissue.shape->elements;
  if (c.method.elements == BoxElements::hex8 || elements == BoxElements::hex8)
    elements = c.method.elements;
  return loaded;
}

std::unique_ptr<Simulation> build_case(const LoadedScene& loaded, Communicator& communicator) {
  std::unique_ptr<Simulation> simulation = build(loaded, communicator);
  if (!simulation->cuts.empty())
    throw InputError(
        "the scene cuts its body: meshes that are cut have different nodes, so a study can't "
        "compare them; leave the scalpel out (--set instrument=[])");
  return simulation;
}

void take_samples(const std::vector<SamplePoint>& points, const Simulation& s, Outcome& outcome) {
  const std::vector<double> u = gather_field(s.part, 3, s.state.u, *s.communicator);
  for (const SamplePoint& point : points) outcome.samples.push_back(interpolate(point, u));
}

bool is_sample_frame(std::int64_t frame, std::int64_t n_frames) {
  for (int k = 1; k <= n_sample_times; ++k)
    if (frame == n_frames * k / n_sample_times) return true;
  return false;
}

void run_frames(const SceneStudy& study, Simulation& s, Outcome& outcome) {
  const std::vector<SamplePoint> points = locate_samples(s.mesh, study.points);
  Outputs outputs;
  while (s.frame < study.n_frames()) {
    const double start = thread_seconds();
    run_frame(s, outputs);
    outcome.stepping_seconds += thread_seconds() - start;
    if (is_sample_frame(s.frame, study.n_frames())) take_samples(points, s, outcome);
  }
}

Outcome solve(const SceneStudy& study, const Case& c) {
  Outcome outcome;
  const double start = thread_seconds();
  const LoadedScene loaded = scene_of(study, c);
  const std::unique_ptr<Simulation> simulation = build_case(loaded, *study.communicator);
  outcome.h = mean_edge_length(simulation->mesh);
  outcome.n_elements = simulation->mesh.n_elements();
  try {
    if (loaded.scene.start.state == StartState::equilibrium)
      start_in_equilibrium(loaded, *simulation);
    outcome.setup_seconds = thread_seconds() - start;
    run_frames(study, *simulation, outcome);
  } catch (const SimulationError& trouble) {
    outcome.trouble = trouble.what();
  }
  outcome.n_steps = simulation->state.step;
  outcome.dt =
      simulation->state.time / static_cast<double>(std::max<std::int64_t>(1, outcome.n_steps));
  return outcome;
}

// Read as the scene's own key is, with all its checks.
std::vector<double> sleeps_of(const SceneStudyOptions& options, const SceneStudy& study) {
  if (options.sleeps.empty()) return {study.loaded.scene.solver.sleep};
  std::vector<double> sleeps;
  for (const std::string& sleep : options.sleeps) {
    std::vector<std::string> overrides = options.overrides;
    overrides.push_back("solver.sleep='" + sleep + "'");
    sleeps.push_back(load_scene(options.scene_file, overrides).scene.solver.sleep);
  }
  return sleeps;
}

std::vector<int> sizes_of(const SceneStudy& study, const std::vector<int>& wanted) {
  std::vector<int> sizes;
  if (study.has_shape()) {
    const SceneShape& shape = *study.loaded.scene.tissue.shape;
    const int n = most_cells(shape), least = std::ranges::max(least_cells(shape.kind));
    sizes = wanted.empty() ? std::vector<int>{std::max(least, n / 4), std::max(least, n / 2), n}
                           : wanted;
    sort_unique(sizes);
    if (sizes.front() < least)
      throw InputError("n = " + std::to_string(sizes.front()) + " is below " +
                       std::to_string(least) +
                       ", the least that makes a mesh of this kind of shape (--sizes, or else "
                       "tissue.shape.cells)");
  } else {
    for (int k = 1; k <= std::max(1, static_cast<int>(study.meshes.size())); ++k)
      sizes.push_back(k);
  }
  return sizes;
}

// Whether the scene's body can have elements of this formulation. In a plane strain and stress are
// two bodies and not two ways to compute one. A scene with local steps (multirate) refuses nodal
// pressures.
bool can_have(const SceneStudy& study, const Mesh& mesh, Formulation formulation) {
  const ElementType shape = shape_of(formulation);
  const bool is_plane = mesh.dimension() == 2;
  const bool is_refused =
      study.loaded.scene.solver.is_multirate && formulation == Formulation::tet4_nodal_pressure;
  if (is_refused) return false;
  if (is_plane && formulation != study.loaded.scene.solver.triangle) return false;
  if (study.has_shape()) return is_plane == (shape == ElementType::tri3);
  return has_type(mesh, shape);
}

void describe(const SceneStudy& study, Problem& problem) {
  const Scene& scene = study.loaded.scene;
  problem.title = scene.name;
  problem.quantity = "greatest distance of a surface point from where the finest run has it";
  problem.unit = "m";
  problem.simulated_seconds = scene.time.duration;
  problem.size_meaning =
      study.has_shape() ? "cells along the direction with most" : "mesh files, coarse to fine";
  if (study.has_shape()) return;
  const std::vector<std::string> meshes =
      study.meshes.empty() ? std::vector<std::string>{scene.tissue.mesh} : study.meshes;
  problem.size_label = [meshes](int n) {
    return std::filesystem::path(meshes[n - 1]).stem().string();
  };
}

SceneStudy load_study(const SceneStudyOptions& options, Communicator& communicator) {
  SceneStudy study{.loaded = load_scene(options.scene_file, options.overrides),
                   .communicator = &communicator};
  study.loaded.scene.outputs.clear();
  study.loaded.scene.markers.clear();
  study.loaded.scene.checkpoint.every = 0;
  study.loaded.scene.time.forget_deadlines();
  if (study.has_shape() && !options.meshes.empty())
    throw InputError("--meshes: the scene generates its body; use --sizes");
  if (!study.has_shape() && !options.sizes.empty())
    throw InputError("--sizes: the scene's body is a mesh file; use --meshes");
  for (const std::string& mesh : options.meshes)
    study.meshes.push_back(std::filesystem::absolute(mesh).string());
  return study;
}

// The finest mesh is what all runs are compared with. Returns the mean edges. [m]
std::vector<double> sort_meshes(SceneStudy& study, Communicator& communicator) {
  std::vector<std::pair<double, std::string>> by_edge;
  for (int n = 1; n <= static_cast<int>(study.meshes.size()); ++n) {
    const Mesh mesh = load_tissue(scene_of(study, {.n = n}), communicator);
    by_edge.emplace_back(mean_edge_length(mesh), study.meshes[n - 1]);
  }
  std::ranges::stable_sort(by_edge, std::ranges::greater(), &std::pair<double, std::string>::first);
  std::vector<double> edges;
  for (std::size_t k = 0; k < by_edge.size(); ++k) {
    edges.push_back(by_edge[k].first);
    study.meshes[k] = by_edge[k].second;
  }
  return edges;
}

}  // namespace

Problem problem_of_scene(const SceneStudyOptions& options, Communicator& communicator) {
  const auto study = std::make_shared<SceneStudy>(load_study(options, communicator));
  Problem problem{.is_scene = true, .edges = sort_meshes(*study, communicator)};
  problem.name = std::filesystem::path(options.scene_file).stem().string();
  describe(*study, problem);
  problem.sizes = sizes_of(*study, options.sizes);
  problem.sleeps = sleeps_of(options, *study);
  Case coarsest{.n = *std::min_element(problem.sizes.begin(), problem.sizes.end())};
  if (study->has_shape() && study->loaded.scene.tissue.shape->elements != BoxElements::hex8)
    coarsest.method.elements = BoxElements::tet4_kuhn;
  const Mesh mesh = load_tissue(scene_of(*study, coarsest), communicator);
  problem.growth = mesh.dimension() + 1;
  problem.factors = {step_factor_of(study->loaded.scene.solver, mesh)};
  study->points = surface_points(mesh, most_sample_points);
  for (const Method& method : methods())
    if (can_have(*study, mesh, method.formulation)) problem.methods.push_back(method);
  problem.solve = [study](const Case& c) { return solve(*study, c); };
  return problem;
}

}  // namespace trocar
