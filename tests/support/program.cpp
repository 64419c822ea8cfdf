#include "program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace trocar {

namespace {

// Of this process; stays for a look where a test failed.
struct AllFolders {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("trocar-test-" + std::to_string(getpid()));

  AllFolders() { std::filesystem::remove_all(path); }
  AllFolders(const AllFolders&) = delete;
  AllFolders& operator=(const AllFolders&) = delete;
  ~AllFolders() {
    std::error_code trouble;
    if (!testing::UnitTest::GetInstance()->Failed()) std::filesystem::remove_all(path, trouble);
  }
};

}  // namespace

std::string test_folder(const std::string& name) {
  static const AllFolders all;
  const std::string folder = (all.path / name).string();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

pid_t start(std::vector<std::string> words, const std::string& out, const std::string& err) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  constexpr int append = O_WRONLY | O_CREAT | O_APPEND;
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), append, 0644);
  posix_spawn_file_actions_addopen(&files, 2, err.c_str(), append, 0644);
  pid_t child = -1;
  const int trouble = posix_spawnp(&child, words[0].c_str(), &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  EXPECT_EQ(trouble, 0) << words[0];
  return trouble == 0 ? child : -1;
}

Finished run_words(std::vector<std::string> words, const std::string& folder, int seconds) {
  std::vector<std::string> all = {"timeout", "-k", "5", std::to_string(seconds)};
  all.insert(all.end(), words.begin(), words.end());
  const std::string out = folder + "/stdout", err = folder + "/stderr";
  for (const std::string& file : {out, err}) std::filesystem::remove(file);
  const pid_t child = start(std::move(all), out, err);
  Finished finished;
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status))
    finished.exit_code = WEXITSTATUS(status);
  finished.out = read_text(out);
  finished.err = read_text(err);
  return finished;
}

Finished run_trocar(const std::vector<std::string>& arguments, const std::string& folder,
                    int seconds) {
  std::vector<std::string> words = {TROCAR_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_words(words, folder, seconds);
}

std::vector<std::string> mpirun_words(int ranks, const std::string& program,
                                      const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {TROCAR_ON_RANKS, std::to_string(ranks), program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

Finished run_trocar_on(int ranks, const std::vector<std::string>& arguments,
                       const std::string& folder, int seconds) {
  return run_words(mpirun_words(ranks, TROCAR_PROGRAM, arguments), folder, seconds);
}

nlohmann::json read_summary(const std::string& folder) {
  return nlohmann::json::parse(read_text(folder + "/summary.json"), nullptr, false);
}

nlohmann::json result_in(const nlohmann::json& summary) {
  nlohmann::json result = nlohmann::json::object();
  for (const char* const key :
       {"state_digest", "frames", "steps", "equilibrium", "mesh", "mass_kg", "added_mass",
        "stable_step_s", "least_det_F", "roll_backs", "searches", "multirate", "share_asleep_mean",
        "instruments", "supports", "wound", "cuts", "energies_J", "events"})
    if (summary.contains(key)) result[key] = summary[key];
  for (auto& cut : result["cuts"])
    for (const char* const of_machine : {"milliseconds", "milliseconds_worst", "ranks"})
      cut.erase(of_machine);
  if (result.contains("equilibrium")) result["equilibrium"].erase("seconds");
  return result;
}

std::string metrics_without_times(const std::string& file) {
  std::istringstream lines(read_text(file));
  std::string kept;
  int seconds = -1;  // their column, known from the first line on
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string cell;
    for (int k = 0; std::getline(cells, cell, ','); ++k) {
      if (cell == "frame_seconds") seconds = k;
      if (k != seconds) kept += cell + ",";
    }
    kept += "\n";
  }
  EXPECT_GE(seconds, 0);
  return kept;
}

std::string config(const std::string& name) {
  return std::string(TROCAR_SOURCE_DIR) + "/configs/" + name;
}

void write_tetrahedra(const std::string& file, const std::vector<std::string>& nodes,
                      const std::vector<std::string>& corners) {
  std::ofstream out(file);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << nodes.size() << '\n';
  for (std::size_t k = 0; k < nodes.size(); ++k) out << k + 1 << ' ' << nodes[k] << '\n';
  out << "$EndNodes\n$Elements\n" << corners.size() << '\n';
  for (std::size_t k = 0; k < corners.size(); ++k)
    out << k + 1 << " 4 2 1 1 " << corners[k] << '\n';
  out << "$EndElements\n";
}

}  // namespace trocar
