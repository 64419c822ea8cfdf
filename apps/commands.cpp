#include "apps/commands.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

#include "apps/read_scale.h"
#include "base/box.h"
#include "base/error.h"
#include "base/host.h"
#include "base/log.h"
#include "base/on_root.h"
#include "base/threads.h"
#include "engine/build.h"
#include "engine/predict.h"
#include "engine/run_files.h"
#include "engine/tissue_table.h"
#include "engine/version.h"
#include "mesh/mesh_file.h"
#include "mesh/quality.h"
#include "render/image_file.h"
#include "render/renderer.h"
#include "solver/simd.h"
#include "solver/step.h"

namespace trocar {

namespace {

// Ranks that share this one's cores: mpirun may bind each to cores of its own. Collective.
int ranks_on_cores(const Communicator& communicator) {
  const std::string mine = host_name() + " " + core_list();
  const std::vector<std::string> all = communicator.all_gather(mine);
  return static_cast<int>(std::count(all.begin(), all.end(), mine));
}

// One set for all ranks, as elements at a border are computed on both sides. Collective; throws
// InputError on every rank.
void select_simd_alike(const std::string& name, const Communicator& communicator) {
  on_every_rank(communicator, [&] { select_simd(name); });
  const auto mine = static_cast<double>(active_simd());
  const double least = communicator.all_min(mine);
  if (least != communicator.all_max(mine))
    throw InputError(
        std::string("ranks would compute with different instructions, which round differently: "
                    "choose one that all hosts have, as with --simd ") +
        name_of(static_cast<Simd>(static_cast<int>(least))));
}

const char* yes_no(bool is_true) {
  return is_true ? "yes" : "NO";
}

// Least stable step of the mesh with the default material. [s]
double default_stable_step(const Mesh& mesh) {
  const Part part = whole_part(mesh);
  const std::vector<Material> materials(mesh.region_name.size());
  const std::vector<double> density(mesh.region_name.size(), Material{}.density);
  const std::vector<FixedMask> fixed(mesh.X.size(), 0);
  const Model model =
      build_model(mesh, part, materials, fixed, lumped_mass(mesh, density, 1e-3), {});
  return *std::min_element(model.element_step.begin(), model.element_step.end());
}

void print_surface(const std::string& file, double scale) {
  const TriangleMesh mesh = read_triangle_mesh(file, scale);
  const Box box = bounding_box(mesh.X);
  const Vec3 size = box.size();
  std::printf(
      "%s: a surface, for instruments\n  vertices   %zu\n  triangles  %zu\n  box        %.4g x "
      "%.4g x %.4g m, from (%.4g, %.4g, %.4g) m\n",
      file.c_str(), mesh.X.size(), mesh.triangle.size(), size.x(), size.y(), size.z(), box.low.x(),
      box.low.y(), box.low.z());
}

constexpr double sliver_quality = 0.02;

void print_mesh(const std::string& file, const Mesh& mesh, const MeshStatistics& m) {
  const Vec3 size = m.box.size();
  std::printf("%s\n  nodes             %d\n", file.c_str(), m.n_nodes);
  for (int type = 0; type < n_element_types; ++type)
    if (const auto n = m.n_elements_by_type[type]; n > 0)
      std::printf("  %-17s %d\n", element_type_name(static_cast<ElementType>(type)), n);
  std::printf("  pieces            %d\n", m.n_pieces);
  if (mesh.dimension() == 3) std::printf("  surface triangles %d\n", m.n_surface_triangles);
  if (m.n_unjoined > 0)
    std::printf(
        "  NOT JOINED        %d nodes lie where nodes of other pieces do: the pieces come "
        "apart unless the mesher merges these nodes\n",
        m.n_unjoined);
  std::printf("  box               %.4g x %.4g x %.4g m, from (%.4g, %.4g, %.4g) m\n", size.x(),
              size.y(), size.z(), m.box.low.x(), m.box.low.y(), m.box.low.z());
  std::printf("  volume            %.5g %s\n", m.volume, mesh.dimension() == 2 ? "m^2" : "m^3");
  std::printf("  edges             %.3g … %.3g m, mean %.3g m\n", m.edge_min, m.edge_max,
              m.edge_mean);
  std::printf("  quality           least %.3f (element %d), mean %.3f (mean ratio, 1 is ideal)\n",
              m.quality_min, m.worst_element, m.quality_mean);
  const bool is_hexahedron = mesh.element_type[m.worst_element] == ElementType::hex8;
  if (m.quality_min <= 0 && is_hexahedron)
    std::printf(
        "  CORNERS           of hexahedra lie beyond the plane of their neighbours (quality below "
        "0): no inverted elements, but hexahedron = \"full\" is not for them\n");
  else if (m.quality_min < sliver_quality)
    std::printf("  SLIVERS           below a quality of %g: a few elements make every step small\n",
                sliver_quality);
  const std::vector<std::int64_t> n_elements = elements_by_region(mesh);
  for (std::size_t k = 0; k < mesh.region_name.size(); ++k)
    if (!mesh.region_name[k].empty())
      std::printf("  region            \"%s\", %jd elements\n", mesh.region_name[k].c_str(),
                  static_cast<std::intmax_t>(n_elements[k]));
  for (const NodeSet& set : mesh.node_sets)
    std::printf("  region            \"%s\", %zu nodes\n", set.name.c_str(), set.node.size());
  std::printf(
      "  stable step       %.4g ms with the default material (3 kPa, 0.45, 1060 kg/m^3), by the "
      "bounds of single elements; \"trocar check\" searches for a scene's own\n",
      1e3 * default_stable_step(mesh));
}

}  // namespace

void use_machine(const MachineOptions& machine, const Communicator& communicator) {
  const int shared = std::max(1, available_cores() / ranks_on_cores(communicator));
  set_thread_count(machine.threads > 0 ? machine.threads : shared);
  select_simd_alike(machine.simd, communicator);
}

ExitCode command_run(const RunOptions& options, Communicator& communicator) {
  const bool is_done = run_scene(options, communicator);
  log_info(options.folder + "/" + summary_name);
  return is_done ? ExitCode::done : ExitCode::stopped;
}

ExitCode command_check(const RunOptions& options, Communicator& communicator) {
  const LoadedScene loaded = share_scene(options.scene_file, options.overrides, communicator);
  const auto simulation = build(loaded, communicator);
  const std::string text = predict(*simulation);
  if (communicator.is_root()) std::fputs(text.c_str(), stdout);
  return ExitCode::done;
}

ExitCode command_replay(const ReplayOptions& options) {
  replay(options);
  return ExitCode::done;
}

ExitCode command_mesh(const std::string& file, const std::string& scale) {
  const double metres = read_scale(scale);
  if (is_surface_file(file)) {
    print_surface(file, metres);
    return ExitCode::done;
  }
  const Mesh mesh = read_mesh(file, metres);
  const MeshStatistics statistics = mesh_statistics(mesh);
  print_mesh(file, mesh, statistics);
  const std::vector<std::string> faults = validate(mesh);
  for (const std::string& fault : faults) std::printf("  FAULT             %s\n", fault.c_str());
  std::printf("  sound             %s%s\n", yes_no(faults.empty()),
              faults.empty() && statistics.n_unjoined > 0 ? ", but NOT JOINED" : "");
  return faults.empty() ? ExitCode::done : ExitCode::input;
}

ExitCode command_doctor(const Communicator& communicator) {
  const std::vector<std::string> hosts = communicator.all_gather(host_name());
  if (!communicator.is_root()) return ExitCode::done;
  std::string reason;
  const bool has_gl = renderer_available(reason);
  const std::string ffmpeg = find_ffmpeg();
  std::error_code trouble;
  const auto disk = std::filesystem::space(".", trouble);
  const std::size_t n_hosts = std::set<std::string>(hosts.begin(), hosts.end()).size();
  std::printf("%s\n  ranks       %zu on %zu host%s, %s\n", version_text().c_str(), hosts.size(),
              n_hosts, n_hosts == 1 ? "" : "s", mpi_version().c_str());
  std::printf("  cores       %d usable by this process, %d threads a rank\n", available_cores(),
              thread_count());
  std::printf("  kernels     %s\n", simd_name());
  std::printf("  pictures    %s%s\n", yes_no(has_gl),
              has_gl ? " (OSMesa)" : (": " + reason).c_str());
  std::printf(
      "  films       %s%s\n", yes_no(!ffmpeg.empty()),
      ffmpeg.empty() ? ": install ffmpeg (Debian package ffmpeg)" : (" (" + ffmpeg + ")").c_str());
  if (!trouble)
    std::printf("  disk        %.1f GB free here\n", static_cast<double>(disk.available) / 1e9);
  return ExitCode::done;
}

ExitCode command_help_scene(bool is_markdown) {
  const Options<Scene> options = scene_options();
  std::fputs((is_markdown ? markdown_options(options) : help_options(options)).c_str(), stdout);
  return ExitCode::done;
}

ExitCode command_help_tissues(bool is_markdown) {
  std::fputs((is_markdown ? tissues_markdown() : tissues_text()).c_str(), stdout);
  return ExitCode::done;
}

}  // namespace trocar
