#include "program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

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

Finished run_words(std::vector<std::string> words, const std::string& folder, int seconds) {
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

std::string config(const std::string& name) {
  return std::string(TROCAR_SOURCE_DIR) + "/configs/" + name;
}

}  // namespace trocar
