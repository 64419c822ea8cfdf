// `trocar cut2d`: the paper's cutting of plane meshes, from the command line.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "cutting/cut_plane.h"

namespace trocar {

struct Cut2dCommand {
  int configuration = 0;              // 0: mesh_file
  std::string mesh_file, mesh_scale;  // scale "": not given
  std::vector<std::string> paths, arcs;
  std::string mode = "robust";
  int repetitions = 0;
  double least_step_ratio = plane_step_ratio;
  bool is_table = false, is_sweep = false, is_json = false;
  int n_cuts = 100;
  std::string svg_folder, markdown_file, docs_folder;
};

// Throws InputError.
ExitCode command_cut2d(const Cut2dCommand& command);

}  // namespace trocar
