#include "apps/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/quoted.h"
#include "engine/version.h"

namespace trocar {

namespace {

const char* const examples_run =
    "\nexamples:\n"
    "  trocar run configs/liver_incision.toml -o out/liver\n"
    "  mpirun -np 4 --map-by slot:PE=2 --bind-to core trocar run scene.toml --threads 2\n"
    "  trocar run configs/liver_incision.toml -o out/liver --resume      after it was stopped or "
    "killed\n"
    "  trocar run scene.toml --set time.duration='2 s' --set tissue.material.young_modulus='5 "
    "kPa'\n";
const char* const examples_check =
    "\nexamples:\n  trocar check configs/block_hex.toml\n  trocar check scene.toml --set "
    "solver.step_factor=0.5\n";
const char* const examples_replay =
    "\nexamples:\n"
    "  trocar replay out/liver/liver_incision.trocar --list\n"
    "  trocar replay out/liver/liver_incision.trocar --video again.mp4 --eye 0.1 -0.2 0.2 -o "
    "again\n"
    "  trocar replay out/liver/liver_incision.trocar --vtu -o vtu      then open vtu/recording.pvd "
    "in ParaView\n";
const char* const examples_study =
    "\nexamples:\n"
    "  trocar study --list\n"
    "  trocar study indentation --sizes 4,8,16 --target '1 %'\n"
    "  trocar study bending-column --elements hex8 --precision single --step-factor 0.5,0.85\n"
    "  trocar study scene.toml --sizes 5,10,20 --target '1 mm' --budget 60\n"
    "  trocar study scene.toml --meshes coarse.msh,middle.msh,fine.msh --set time.duration='1 s'\n"
    "  trocar study --all --docs docs\n";
const char* const examples_cut2d =
    "\nexamples:\n"
    "  trocar cut2d --table1\n"
    "  trocar cut2d --config 2 --mode or --svg out\n"
    "  trocar cut2d --config 4 --path '-1,24 40,30 55,10' --svg out\n"
    "  trocar cut2d --config 2 --path '-1,20 71,22' --path '30,-1 38,41'      two crossing cuts\n"
    "  trocar cut2d --mesh plate.msh --scale '1 mm' --arc '10,10 30,25 50,10' --json\n"
    "  trocar cut2d --sweep --cuts 100 --docs docs\n";
const char* const examples_mesh =
    "\nexamples:\n  trocar mesh liver.msh\n  trocar mesh liver.msh --scale '1 mm'\n";
const char* const examples_doctor = "\nexamples:\n  trocar doctor\n  mpirun -np 4 trocar doctor\n";
const char* const examples_help =
    "\nexamples:\n  trocar help scene\n  trocar help scene --markdown > docs/scene.md\n"
    "  trocar help tissues --markdown > docs/tissues.md\n";

void add_quiet(CLI::App& app, MachineOptions& machine) {
  app.add_flag("-q,--quiet", machine.is_quiet, "Warnings and errors only");
}

void add_kernel_options(CLI::App& app, MachineOptions& machine) {
  app.add_option("--simd", machine.simd,
                 "Instruction set of the kernels: auto, scalar, sse2, avx2, avx512 (bits are "
                 "promised per set)");
  add_quiet(app, machine);
}

void add_machine_options(CLI::App& app, MachineOptions& machine) {
  app.add_option("--threads", machine.threads,
                 "Threads a rank; 0: the cores that it may use, divided among the ranks that share "
                 "them")
      ->check(CLI::Range(0, 1024));
  app.add_option("--patience", machine.patience,
                 "Seconds after which a run ends that waits for a rank of the same host which is "
                 "stopped (SIGSTOP, a debugger)")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  add_kernel_options(app, machine);
}

void add_scene_options(CLI::App& app, RunOptions& run) {
  app.add_option("scene", run.scene_file, "Scene file (TOML)")->required();
  app.add_option("--set", run.overrides,
                 "Change a key of the scene: --set time.duration='2 s', in a list --set "
                 "'instrument[0].radius=2 mm'; may be repeated")
      ->allow_extra_args(false);
}

void add_run(CLI::App& app, CommandLine& line) {
  CLI::App* run =
      app.add_subcommand("run", "Run a scene; writes summary.json and the scene's outputs");
  add_scene_options(*run, line.run);
  run->add_option("-o,--output", line.run.folder, "Folder for everything that is written")
      ->capture_default_str();
  run->add_flag(
      "--resume", line.run.is_resumed,
      "Continue the run that was stopped in the output folder from its last checkpoint, to "
      "the same bits, on any number of ranks and threads. The scene must be the same but for "
      "time.duration, time.pace, time.overrun, [checkpoint], cameras and outputs. Recording, "
      "metrics and pictures go on; films and contact sheets can't: they go on in "
      "NAME.from-frame-N.mp4 "
      "(trocar replay makes a whole film of the recording)");
  add_machine_options(*run, line.machine);
  run->footer(examples_run);
  run->callback([&] { line.command = Command::run; });
}

void add_check(CLI::App& app, CommandLine& line) {
  CLI::App* check =
      app.add_subcommand("check", "Read and check a scene, predict its cost; runs nothing");
  add_scene_options(*check, line.run);
  add_machine_options(*check, line.machine);
  check->footer(examples_check);
  check->callback([&] { line.command = Command::check; });
}

void add_study(CLI::App& app, CommandLine& line) {
  CLI::App* study = app.add_subcommand(
      "study",
      "Run time against error: sweep size, elements, precision and time step of a built-in problem "
      "or a scene; writes CSV, JSON and a plot, and says what is cheapest for an error");
  StudyOptions& s = line.study;
  study->add_option("subject", s.subject, "Built-in problem (--list) or scene file (TOML)");
  study->add_option("-o,--output", s.folder, "Folder for everything that is written")
      ->capture_default_str();
  study->add_flag("--list", s.list, "Print the built-in problems");
  study->add_flag("--all", s.all, "All built-in problems");
  study->add_option("--docs", s.docs, "With --all: folder for accuracy.md and images/");
  study->add_option("--sizes", s.sweep.sizes, "Cells along an edge: 4,8,16")
      ->delimiter(',')
      ->check(CLI::Range(1, 2000));
  study->add_option("--meshes", s.meshes, "Mesh files of a scene, in any order")->delimiter(',');
  study->add_option("--elements", s.sweep.elements, "Elements; all that fit if absent")
      ->delimiter(',');
  study->add_option("--precision", s.sweep.precisions, "double,single; both if absent")
      ->delimiter(',');
  study->add_option("--step-factor", s.sweep.step_factors, "Time step / stable step: 0.5,0.9")
      ->delimiter(',')
      ->check(CLI::Range(1e-3, 1.0));
  study
      ->add_option(
          "--sleep", s.sleeps,
          "solver.sleep of a scene: 0,'0.1 mm'; notes say how far runs are from the same ones "
          "without sleep")
      ->delimiter(',');
  study->add_option("--target", s.target, "Error that the advice is for: '1 mm', '1 %'");
  study
      ->add_option("--budget", s.sweep.budget,
                   "Processor seconds of a sweep; runs that would not fit are left out")
      ->check(CLI::Range(1e-3, 1e9));
  study->add_option("--set", s.overrides, "Change a key of the scene; may be repeated")
      ->allow_extra_args(false);
  const std::vector<CLI::Option*> own = study->get_options();
  add_kernel_options(*study, line.machine);
  study->footer(examples_study);
  study->callback([&line, own] {
    const auto is_given = [](const CLI::Option* option) { return option->count() > 0; };
    if (line.study.list && std::ranges::count_if(own, is_given) > 1)
      throw CLI::ValidationError("--list", "goes alone");
    line.command = Command::study;
  });
}

void add_cut2d_figures(CLI::App& cut2d, Cut2dCommand& c) {
  cut2d.add_option("--svg", c.svg_folder, "Folder for pictures of the mesh before and after");
  cut2d.add_flag("--json", c.is_json, "Print JSON in place of text");
  cut2d.add_option("--markdown", c.markdown_file, "With --table1: write the table to this file");
  cut2d
      .add_option(
          "--repeat", c.repetitions,
          "How often each cut is made, from mesh and path to edited mesh; the fastest and the "
          "median time are printed. 0: as often as begins within 0.25 s")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  cut2d
      .add_option("--least-step-ratio", c.least_step_ratio,
                  "Floor under the stable step after / before a robust cut: what would sink below "
                  "it stays joined. 0: none")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  cut2d.add_flag("--table1", c.is_table, "All of Table 1, the printed figures beside ours");
  cut2d.add_flag("--sweep", c.is_sweep,
                 "Study the parameters of the combined system with random cuts");
  cut2d.add_option("--cuts", c.n_cuts, "With --sweep: random cuts a mesh and point")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  cut2d.add_option("--docs", c.docs_folder,
                   "With --sweep: folder for cutting-parameters.md and images/");
}

// What would have no effect is refused.
void pair_cut2d_options(CLI::App& cut2d) {
  CLI::Option* const table = cut2d.get_option("--table1");
  CLI::Option* const sweep = cut2d.get_option("--sweep");
  // They bring their own meshes and cuts.
  for (const char* own : {"--config", "--mesh", "--path", "--arc", "--mode", "--least-step-ratio"})
    cut2d.get_option(own)->excludes(table)->excludes(sweep);
  for (const char* figure : {"--svg", "--json", "--repeat", "--table1"})
    cut2d.get_option(figure)->excludes(sweep);
  for (const char* of_sweep : {"--cuts", "--docs"}) cut2d.get_option(of_sweep)->needs(sweep);
  cut2d.get_option("--markdown")->needs(table);
  cut2d.get_option("--config")->excludes(cut2d.get_option("--mesh"));
}

void add_cut2d(CLI::App& app, CommandLine& line) {
  CLI::App* cut2d = app.add_subcommand(
      "cut2d",
      "Cut a plane mesh by the algorithm of Serby, Harders and Szekely (2001); reproduce its Table "
      "1");
  Cut2dCommand& c = line.cut2d;
  cut2d->add_option("--config", c.configuration, "Mesh (and cut) of the paper's configuration")
      ->check(CLI::Range(1, 6));
  cut2d->add_option("--mesh", c.mesh_file, "Own mesh of triangles (.msh, .vtk, .vtu)");
  cut2d->add_option("--scale", c.mesh_scale,
                    "Length of one unit of the file of --mesh; 1 mm if absent");
  cut2d
      ->add_option("--path", c.paths,
                   "Cut through these points in mm: 'x,y x,y …'; several are cut one after another")
      ->allow_extra_args(false);
  cut2d
      ->add_option("--arc", c.arcs,
                   "Cut along the arc through three points in mm; after all --path")
      ->allow_extra_args(false);
  cut2d
      ->add_option("--mode", c.mode,
                   "robust (Trocar's), paper (as published), or (the paper's subdivision)")
      ->check(CLI::IsMember({"robust", "paper", "or"}))
      ->capture_default_str();
  add_cut2d_figures(*cut2d, c);
  add_quiet(*cut2d, line.machine);
  pair_cut2d_options(*cut2d);
  cut2d->footer(examples_cut2d);
  cut2d->callback([&, cut2d] {
    if (cut2d->count("--least-step-ratio") > 0 && c.mode != "robust")
      throw CLI::ValidationError("--least-step-ratio", "belongs to --mode robust");
    line.command = Command::cut2d;
  });
}

void add_replay(CLI::App& app, CommandLine& line) {
  CLI::App* replay = app.add_subcommand(
      "replay", "Show a recording again: film, pictures, VTU for ParaView; nothing is simulated");
  ReplayOptions& r = line.replay;
  replay->add_option("recording", r.recording, "Recording (.trocar)")->required();
  add_quiet(*replay, line.machine);
  replay->add_option("-o,--output", r.folder, "Folder")->capture_default_str();
  CLI::Option* video = replay->add_option("--video", r.video, "Write a film of this name");
  CLI::Option* frames =
      replay->add_flag("--frames", r.writes_frames, "Write PNG files into frames/");
  CLI::Option* vtu = replay->add_flag("--vtu", r.writes_vtu, "Write VTU files and recording.pvd");
  replay->add_flag("--list", r.is_list, "Print frames, times and state digests")
      ->excludes(video)
      ->excludes(frames)
      ->excludes(vtu);
  replay->add_option("--from", r.from, "First time [s]");
  replay->add_option("--to", r.to, "Last time [s]");
  replay->add_option("--camera", r.camera, "Camera of the scene; the first if absent");
  replay->add_option("--eye", r.eye, "Own viewpoint x y z [m]")->expected(3);
  replay->add_option("--target", r.target, "Own point looked at x y z [m]")->expected(3);
  replay->add_option("--width", r.width, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  replay->add_option("--height", r.height, "Pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  replay->footer(examples_replay);
  replay->callback([&] { line.command = Command::replay; });
}

void add_others(CLI::App& app, CommandLine& line) {
  CLI::App* mesh =
      app.add_subcommand("mesh", "Sizes, quality, stable step and what is wrong with a mesh file");
  mesh->add_option("file", line.mesh_file, "Mesh (.msh, .vtk, .vtu) or surface (.stl, .obj)")
      ->required();
  mesh->add_option("--scale", line.mesh_scale, "Length of one unit of the file")
      ->capture_default_str();
  mesh->footer(examples_mesh);
  mesh->callback([&] { line.command = Command::mesh; });
  CLI::App* doctor =
      app.add_subcommand("doctor", "What this machine offers, what is missing and how to get it");
  doctor->footer(examples_doctor);
  doctor->callback([&] { line.command = Command::doctor; });
  CLI::App* help = app.add_subcommand("help", "Explain something: scene, tissues, a sub-command");
  help->add_subcommand("scene", "All keys of a scene file with units, ranges and defaults")
      ->add_flag("--markdown", line.is_markdown, "As Markdown");
  help->require_subcommand(1);
  help->footer(examples_help);
  CLI::App* tissues =
      help->add_subcommand("tissues", "The tissues that a scene can name, and their sources");
  tissues->add_flag("--markdown", line.is_markdown, "As Markdown");
  help->callback([&, tissues] {
    line.command = tissues->parsed() ? Command::help_tissues : Command::help_scene;
  });
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// "trocar help" is "trocar --help", "trocar help run" is "trocar run --help".
std::vector<const char*> words_of(const CLI::App& app, int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc < 2 || std::string(argv[1]) != "help") return words;
  if (argc == 2) return {words[0], "--help"};
  if (argc == 3 && is_one_of(words[2], names_of_commands(app)))
    return {words[0], words[2], "--help"};
  return words;
}

// What is wrong, the word that was probably meant ("trocar rnu"), and where help is.
std::string complaint(const CLI::App& app, const std::string& trouble, int argc, char** argv) {
  const std::vector<std::string> known = names_of_commands(app);
  const std::string word = argc < 2 ? "" : argv[1];
  if (word == "help" && argc == 3)
    return "there is no help on " + in_quotes(argv[2]) + ", only on scene, tissues and commands" +
           "\nrun \"trocar help\" for what there is";
  if (is_one_of(word, known))
    return trouble + "\nrun \"trocar " + word + " --help\" for what there is";
  const std::string end = "\nrun \"trocar --help\" for what there is";
  if (word.empty() || word[0] == '-') return trouble + end;
  return "there is no sub-command " + in_quotes(word) + names_hint(word, known) + end;
}

// The rank that mpirun gave this process, before MPI is started: only rank 0 prints.
bool is_first_process() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  return rank == nullptr || std::string(rank) == "0";
}

}  // namespace

bool parse_command_line(int argc, char** argv, CommandLine& line, ExitCode& code) {
  CLI::App app("Headless real-time surgical simulation.", "trocar");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "\nStart with: trocar run configs/liver_incision.toml -o out\nEvery sub-command explains "
      "itself: trocar run --help");
  add_run(app, line);
  add_check(app, line);
  add_study(app, line);
  add_cut2d(app, line);
  add_replay(app, line);
  add_others(app, line);
  try {
    const std::vector<const char*> words = words_of(app, argc, argv);
    app.parse(static_cast<int>(words.size()), words.data());
    return true;
  } catch (const CLI::Success& help) {
    if (is_first_process()) app.exit(help);
    code = ExitCode::done;
  } catch (const CLI::ParseError& trouble) {
    if (is_first_process())
      std::fprintf(stderr, "trocar: %s\n", complaint(app, trouble.what(), argc, argv).c_str());
    code = ExitCode::input;
  }
  return false;
}

ExitCode run_command(const CommandLine& line, Communicator& communicator) {
  use_machine(line.machine, communicator);
  switch (line.command) {
    case Command::run:
      return command_run(line.run, communicator);
    case Command::check:
      return command_check(line.run, communicator);
    case Command::study:
      return command_study(line.study, communicator);
    case Command::cut2d:
      return communicator.is_root() ? command_cut2d(line.cut2d) : ExitCode::done;
    case Command::replay:
      return communicator.is_root() ? command_replay(line.replay) : ExitCode::done;
    case Command::mesh:
      return communicator.is_root() ? command_mesh(line.mesh_file, line.mesh_scale)
                                    : ExitCode::done;
    case Command::doctor:
      return command_doctor(communicator);
    case Command::help_scene:
      return communicator.is_root() ? command_help_scene(line.is_markdown) : ExitCode::done;
    case Command::help_tissues:
      return communicator.is_root() ? command_help_tissues(line.is_markdown) : ExitCode::done;
  }
  return ExitCode::done;
}

}  // namespace trocar
