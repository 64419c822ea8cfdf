// Starts the program as a user would and keeps what it says.
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test_files.h"

namespace trocar {

// A folder of its own for a test, empty at the beginning and gone with the process.
std::string test_folder(const std::string& name);

// Starts `words`, without a shell, and lets them run on; what they say goes to the ends of two
// files, or of one.
pid_t start(std::vector<std::string> words, const std::string& out, const std::string& err);

struct Finished {
  int exit_code = -1;  // -1: killed by a signal
  std::string out, err;
};

// Runs `words` with a time limit by the `timeout` program; no shell.
Finished run_words(std::vector<std::string> words, const std::string& folder, int seconds = 300);

Finished run_trocar(const std::vector<std::string>& arguments, const std::string& folder,
                    int seconds = 300);

std::vector<std::string> mpirun_words(int ranks, const std::string& program,
                                      const std::vector<std::string>& arguments);

// Under mpirun with this many ranks.
Finished run_trocar_on(int ranks, const std::vector<std::string>& arguments,
                       const std::string& folder, int seconds = 300);

nlohmann::json read_summary(const std::string& folder);

// Of a summary, what any run of the scene has: on any ranks and threads, resumed or not.
nlohmann::json result_in(const nlohmann::json& summary);

// A metrics file without the wall times of the frames.
std::string metrics_without_times(const std::string& file);

std::string config(const std::string& name);

// A gmsh file of tetrahedra: nodes "x y z", corners "1 2 3 4" by the nodes' numbers from 1 on.
void write_tetrahedra(const std::string& file, const std::vector<std::string>& nodes,
                      const std::vector<std::string>& corners);

}  // namespace trocar
