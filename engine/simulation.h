// A scene that runs: the parts, as data. A part that the scene lacks is empty and costs one `if` a
// frame.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.h"
#include "base/least_of_many.h"
#include "base/timers.h"
#include "engine/added_mass.h"
#include "engine/blade_drag.h"
#include "engine/contact_stage.h"
#include "engine/cut_stage.h"
#include "engine/energy_ledger.h"
#include "engine/frame_log.h"
#include "engine/global_state.h"
#include "engine/holds.h"
#include "engine/loads.h"
#include "engine/local_steps.h"
#include "engine/markers.h"
#include "engine/scene.h"
#include "engine/sleep.h"
#include "engine/surface_view.h"
#include "engine/tool.h"
#include "mesh/element_boxes.h"
#include "mesh/facets.h"
#include "mesh/node_corners.h"
#include "mesh/partition.h"
#include "solver/rank_body.h"
#include "solver/watch.h"

namespace trocar {

// Indices of PhaseTimers, in this order.
enum Phase : std::size_t {
  phase_detect,
  phase_force,
  phase_contact,
  phase_integrate,
  phase_exchange,
  phase_cut,
  phase_watch,
  phase_gather,
  phase_output,
  phase_checkpoint,
  phase_wait,
  n_phases
};

inline constexpr const char* phase_names[n_phases] = {"contact detection",
                                                      "element forces",
                                                      "contact forces",
                                                      "integration",
                                                      "halo exchange",
                                                      "cutting",
                                                      "watch",
                                                      "gather",
                                                      "output",
                                                      "checkpoint",
                                                      "waiting"};

// Searches for the highest frequency; the same on all ranks.
struct SearchMemory {
  std::int64_t at_step = 0;  // State::step of the last one of the body
  double step = 0;           // stable there; 0 without a search, or where it did not end [s]
  double of_small = 1;       // that without local steps over it, or less
  // Searches of parts since then (part_search.h): what the body's omega^2 may have grown by, by the
  // last one, and growth of the elements at which the last one was thought of.
  double growth = 1, asked = 1;
  // What takes the place of these elements' stiffening, by number.
  std::vector<GrownElement> searched;
};

// Where the stable step of the body was last found, from which it follows (body_search.h).
struct ElementLook : SearchMemory {
  bool is_done = false;
  // (n_owned * 3) [m] Displacements there, none before; frames share them with their beginnings.
  std::shared_ptr<const std::vector<double>> displacements;
  std::span<const double> u() const {
    return displacements ? *displacements : std::span<const double>();
  }
  // (n local elements) growth of their omega^2 there; none until it is needed, and the elements are
  // looked at in any case.
  std::optional<std::vector<double>> stiffening;
  // Global numbers of this rank's elements that set the step and the growth at the last look; -1:
  // not known.
  std::array<std::int32_t, 2> decisive = {-1, -1};
  double reach = 0;  // of a node that strains its elements by less than unseen_strain [m]
};

// The base is this rank's share.
struct Simulation : RankBody {
  Communicator* communicator = nullptr;  // owned by main
  Scene scene;

  // Replicated on every rank.
  Mesh mesh;
  NodeCorners corners;                   // empty before the first cut, unless prepared for it
  ElementBoxes boxes;                    // the same; of positions at some time
  std::vector<Material> materials;       // (n_regions)
  std::vector<double> mass;              // (n_nodes) [kg]
  double whole_mass = 0;                 // of the uncut body [kg]
  std::vector<FixedMask> fixed;          // (n_nodes)
  std::vector<std::int32_t> node_owner;  // (n_nodes)
  double chosen_imbalance = 0;           // imbalance() when they were chosen; 0: not noted yet
  Surface surface;
  // Pairs of partner nodes, over all cuts, that have not come into two pieces.
  std::vector<std::int32_t> duplicate_parent, duplicate_node;
  std::int32_t n_pieces = 1;  // that the body has fallen into

  std::vector<Tool> tools;
  Holds holds;  // grasped nodes and moving supports
  Loads loads;
  std::vector<Location> markers;
  std::unique_ptr<ContactStage> contact;  // only with instruments or contact.tissue
  std::vector<CutStage> cuts;             // one an instrument that cuts
  BladeDrag drag;                         // of this frame
  WaitingNodes waiting;                   // in this frame: those of contacts, holds and drag
  GlobalState cut_state;                  // of this frame's cuts; kept for its memory
  SurfaceView view;                       // positions of surface nodes, replicated, once a frame

  std::int64_t frame = 0;        // frames done
  std::int64_t first_frame = 0;  // where this process began: 0, or the checkpoint it resumed from
  std::uint32_t body_crc = 0;    // of the mesh at time zero and the user's tool surfaces
  double contact_reach = 0;      // how far tissue may come towards a tool within a frame [m]
  double start_seconds = 0;      // monotonic clock at time zero of the scene; deadlines may move it
  std::unique_ptr<EnergyLedger> energy;      // only with a metrics output
  std::optional<LocalStepPlan> local_steps;  // only if the scene asks for it; replicated
  std::unique_ptr<MultiRate> multirate;      // of it, if it saves work
  bool has_local_steps = false;              // in this frame
  std::optional<Sleep> sleep;                // only if the scene asks for it
  double step_factor = 0.85;                 // of the scene: step_factor_of
  double step_scale = 1;                     // halved by each roll-back, then rises slowly
  // The stable step falls at once and rises slowly (step_rise in frame.cpp): that of the tissue,
  // and what contact leaves, whether small elements take local steps or not. [s]
  double held_step = std::numeric_limits<double>::infinity(), held_by_contact = held_step;
  Watch watch;  // of the last frame, over all ranks
  ElementLook look;
  State frame_start;                               // where a frame goes back to
  std::vector<double> altitude;                    // (n local elements) least one, undeformed [m]
  LeastOfMany least_altitude, least_element_step;  // of altitude and the model's element_step
  double rest_step = 0;    // least element bound of the undeformed mesh, over all ranks [s]
  double edge_length = 0;  // mean of the mesh at time zero [m]
  std::optional<MassScaling> mass_scaling;  // only if the scene asks for it; replicated
  std::optional<AddedMass> added_mass;      // by it
  FrameLog log;                             // what each frame told
  PhaseTimers timers;
};

// Of a node of this rank, by its local number. [m]
inline Vec3 present_position(const Simulation& s, std::int32_t local) {
  return s.mesh.X[s.part.node_global[local]] +
         Vec3::Map(&s.state.u[3 * static_cast<std::size_t>(local)]);
}

// Of the scene's [solver].
SolverOptions solver_options(const Scene& scene);

// Everything that follows from mesh and owners: after building and after each edit.
void rebuild_topology(Simulation& s);
// Counts the pieces of the body; between two of them there is no wound.
void find_pieces(Simulation& s);

}  // namespace trocar
