// Shows a recording again without simulating.
#pragma once

#include <string>
#include <vector>

#include "engine/scene.h"

namespace trocar {

struct ReplayOptions {
  std::string recording;
  std::string folder = "replay";
  std::string video;                // file name in the folder, "" for none
  bool writes_frames = false;       // PNG files
  bool writes_vtu = false;          // VTU files and a PVD for ParaView
  bool is_list = false;             // print frames, times and digests only
  double from = 0, to = 1e300;      // [s]
  std::string camera;               // of the scene; "" for the first
  std::vector<double> eye, target;  // a view of the user's own, overrides the camera
  int width = 1280, height = 720;
};

// Throws InputError for a recording that can't be read, MachineError for what can't be written.
void replay(const ReplayOptions& options);

}  // namespace trocar
