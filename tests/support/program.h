// Starts the program as a user would and keeps what it says.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

extern char** environ;

namespace trocar {

// A folder of its own for a test, empty at the beginning.
inline std::string test_folder(const std::string& name) {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("trocar-test-" + std::to_string(getpid()) + "-" + name))
                                 .string();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string read_text(const std::string& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Finished {
  int exit_code = -1;  // -1: killed by a signal
  std::string out, err;
};

// Runs `words` with a time limit by the `timeout` program; no shell.
inline Finished run_words(std::vector<std::string> words, const std::string& folder,
                          int seconds = 300) {
  std::vector<std::string> all = {"timeout", "-k", "5", std::to_string(seconds)};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, (folder + "/stdout").c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_addopen(&files, 2, (folder + "/stderr").c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  pid_t child = 0;
  Finished finished;
  if (posix_spawnp(&child, "timeout", &files, nullptr, argv.data(), environ) == 0) {
    int status = 0;
    waitpid(child, &status, 0);
    finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  posix_spawn_file_actions_destroy(&files);
  finished.out = read_text(folder + "/stdout");
  finished.err = read_text(folder + "/stderr");
  return finished;
}

inline Finished run_trocar(const std::vector<std::string>& arguments, const std::string& folder,
                           int seconds = 300) {
  std::vector<std::string> words = {TROCAR_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_words(words, folder, seconds);
}

inline std::vector<std::string> mpirun_words(int ranks, const std::string& program,
                                             const std::vector<std::string>& arguments) {
  std::vector<std::string> words;
  std::stringstream mpirun(TROCAR_MPIRUN);
  for (std::string word; mpirun >> word;) words.push_back(word);
  words.insert(words.end(), {"-np", std::to_string(ranks), program});
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

// Under mpirun with this many ranks.
inline Finished run_trocar_on(int ranks, const std::vector<std::string>& arguments,
                              const std::string& folder, int seconds = 300) {
  return run_words(mpirun_words(ranks, TROCAR_PROGRAM, arguments), folder, seconds);
}

inline nlohmann::json read_summary(const std::string& folder) {
  return nlohmann::json::parse(read_text(folder + "/summary.json"), nullptr, false);
}

inline std::string config(const std::string& name) {
  return std::string(TROCAR_SOURCE_DIR) + "/configs/" + name;
}

}  // namespace trocar
