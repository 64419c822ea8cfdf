// The metrics of a run: one CSV row a frame, flushed as it comes.
#pragma once

#include <fstream>
#include <span>
#include <string>

#include "engine/frame_log.h"
#include "engine/tool.h"

namespace trocar {

class MetricsFile {
 public:
  // Throws MachineError if the file can't be written (here and below).
  MetricsFile(const std::string& file, std::span<const Tool> tools,
              std::span<const std::string> supports, std::span<const SceneMarker> markers);
  void add(const FrameRow& row);

 private:
  void check();
  std::string file_;
  std::ofstream stream_;
};

}  // namespace trocar
