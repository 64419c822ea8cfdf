// Runs scenes one after the other on the ranks it was started with, each on one thread and on two,
// as the program does: starting ranks takes longer than a small scene.
//   scene_digests FOLDER: FOLDER/list has a line "<scene file><tab><output folder><tab><duration of
//   a first run or nothing><tab><override>…" a scene; output folders get "-1" or "-2" appended.
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/communicator.h"
#include "base/log.h"
#include "base/threads.h"
#include "engine/run.h"
#include "solver/step.h"

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, '\t');) words.push_back(word);
  return words;
}

void run(const std::vector<std::string>& words, int n_threads, trocar::Communicator& world) {
  trocar::set_thread_count(n_threads);
  trocar::RunOptions options{.scene_file = words.at(0),
                             .folder = words.at(1) + "-" + std::to_string(n_threads),
                             .overrides = {words.begin() + 3, words.end()}};
  const std::string& first_half = words.at(2);
  if (!first_half.empty()) {
    options.overrides.push_back("time.duration='" + first_half + "'");
    run_scene(options, world);
    options.overrides.pop_back();
    options.is_resumed = true;
  }
  run_scene(options, world);
}

}  // namespace

int main(int argc, char** argv) {
  trocar::MpiSession session(&argc, &argv);
  trocar::start_log(session.world().rank(), true);
  try {
    trocar::select_simd("auto");
    std::ifstream list(std::string(argc > 1 ? argv[1] : ".") + "/list");
    for (std::string line; std::getline(list, line);)
      for (const int n_threads : {1, 2}) run(split(line), n_threads, session.world());
  } catch (const std::exception& trouble) {
    std::fprintf(stderr, "%s\n", trouble.what());
    trocar::abort_all_ranks(1);
  }
}
