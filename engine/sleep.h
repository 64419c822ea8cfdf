// Skips what is at rest ([solver] sleep). A node is quiet if it has stayed within a sixteenth of
// the bound for half a second, or for the time in which the body's slowest motion turns back or
// dies down if that is longer, and sleeps if it and all nodes it shares an element with are quiet.
// Sleeping nodes don't move, and blocks of elements whose nodes all sleep are left out: who sleeps
// is decided by node, so it does not depend on ranks and threads, and which blocks are left out
// does not matter to the nodes that are awake.
// A frame in which a node beside sleeping ones goes further than a quarter of the bound from where
// it was when it came to lie there, or in which a contact or a hold touches sleeping ones, a blade
// is in the tissue or a load changes, is done again with all awake: pressure waves cross an organ
// within a frame, so there is no use in waking a neighbourhood. All wake, too, after a frame in
// which the forces on instruments or the ways of supports have left the range that sleepers were
// quiet in: what is awake around the place is held by those asleep, so its motion doesn't tell.
// What sleeps thus misses the eighth in which it was found quiet and about as much as its
// surroundings moved, a quarter. That is an estimate, not a proof: what no support holds may turn
// back more slowly, and is stopped, too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/frame_log.h"
#include "engine/quiet_range.h"
#include "mesh/partition.h"
#include "solver/model.h"

namespace trocar {

struct Simulation;

// Who sleeps and who has been quiet: what waking changes.
struct SleepRoll {
  double quiet_time = 0;                   // of who sleeps [s]; 0: nobody was near it yet
  std::vector<std::int32_t> quiet;         // (n_owned) frames at the anchor; -1: it has none yet
  std::vector<std::uint8_t> is_asleep;     // (n_local)
  std::vector<std::uint8_t> is_beside;     // (n_owned) awake, with a sleeping neighbour
  std::vector<std::uint8_t> block_sleeps;  // Scratch::is_asleep
  double share = 0;                        // of all nodes that sleep
  QuietRange range;
};

struct Sleep : SleepRoll {
  double bound = 0;                    // on the error of displacements [m]
  std::vector<double> anchor;          // (n_owned * 3) displacement that it is quiet around [m]
  std::vector<double> watched;         // (n_owned * 3) that when it came to lie beside sleepers [m]
  std::vector<FixedMask> awake_fixed;  // (n_owned) Model::fixed with all awake
};

// All awake, after the topology was built; nothing if the scene doesn't ask for sleep.
void begin_sleep(Simulation& s);
// After a frame that went well and told this of the tools, before its outputs. Collective.
void fall_asleep(Simulation& s, std::span<const ToolRow> tools);
// Wakes all if a contact, a hold or a blade touches what sleeps or a load changes. Collective.
void wake_touched(Simulation& s);
// Whether a node beside sleeping ones has moved too far; then all are awake. Collective.
bool wake_disturbed(Simulation& s);

// Before and after an edit of the topology: all awake, room for new nodes.
void wake_all(Simulation& s);
void fit_sleep(Simulation& s);

// The model as if all were awake, and back: for searches that want all of it.
void show_awake(Simulation& s);
void show_asleep(Simulation& s);

// (n_nodes * 7 + 1) anchors, watched displacements, quiet frames (-2 less these where it sleeps),
// then the quiet time, for checkpoints: on the root, empty elsewhere. Collective.
std::vector<double> gather_sleep(Simulation& s);
void restore_sleep(std::span<const double> memory, Simulation& s);

}  // namespace trocar
