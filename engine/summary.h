// summary.json: what a run did, in numbers.
#pragma once

#include <string>

#include "engine/simulation.h"

namespace trocar {

struct RunTimes {
  double setup_seconds = 0;    // reading, partition, building
  double loop_seconds = 0;     // all frames
  double finish_seconds = 0;   // waiting for encoders, closing files
  double drawing_seconds = 0;  // of the picture thread, beside the loop
};

// The text of summary.json; digest and mass are gathered. Collective; the text is the same on every
// rank except for times. trouble: the sentence that ended the run early, "" if it went through.
std::string make_summary(Simulation& s, const RunTimes& times, const std::string& trouble);

}  // namespace trocar
