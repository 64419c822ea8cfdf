// Whole scenes: thin tissue that a fast instrument strikes or two instruments pinch, instruments
// that leave at once, supports and loads that jump.
#include "base/error.h"
#include "collision/closest_point.h"
#include "engine/energy_ledger.h"
#include "engine/event_log.h"
#include "engine_started.h"
#include "stability_body.h"

namespace trocar {

namespace {

constexpr double thickness = 1e-3, layer = thickness / 5;  // of the sheet that is struck [m]
constexpr double side = .03;                               // of a block [m]

// Of the surface in any piece of a probe, both as they are now. [m]
double depth_in(const Simulation& s, const Tool& probe) {
  const Pose pose = probe.path.at(s.log.rows.back().time);
  double depth = 0;
  for (const ConvexPiece& piece : probe.shape.pieces) {
    const Segment axis{pose.apply(piece.points.front()), pose.apply(piece.points.back())};
    for (const std::array<std::int32_t, 3>& corner : s.surface.triangle) {
      Triangle x;
      for (std::size_t a = 0; a < 3; ++a)
        x[a] = s.mesh.X[corner[a]] + Vec3::Map(&s.state.u[3 * static_cast<std::size_t>(corner[a])]);
      const double distance2 = closest_points_segment_triangle(axis, x).distance2;
      depth = larger_or_nan(depth, piece.radius - std::sqrt(distance2));
    }
  }
  return depth;
}

struct Course {
  double depth = 0;                 // of tissue in instruments [m]
  double work = 0, miss = 0;        // of contact, largest; of the balance of energies [J]
  double stored = 0;                // at the end, with what moves [J]
  double fastest = 0, kinetic = 0;  // largest and at the end [J]
  std::int64_t n_roll_backs = 0;
  double share_missing = 0;  // of the energies turned over
  bool is_told = false;  // roll-backs, and what of the energies is missing, are among the events
  std::string end;       // the sentence, if it ended early
};

void note_frame(const Simulation& s, Course& course) {
  const FrameRow& row = s.log.rows.back();
  for (const Tool& tool : s.tools) course.depth = larger_or_nan(course.depth, depth_in(s, tool));
  course.work = larger_or_nan(course.work, row.works.contact);
  course.miss = larger_or_nan(course.miss, std::abs(row.energy_error));
  course.fastest = larger_or_nan(course.fastest, row.energy.kinetic);
  course.kinetic = row.energy.kinetic;
  course.stored = row.energy.kinetic + row.energy.strain;
}

Course run_scene(const std::string& text, int n_frames) {
  const auto started = built(text);
  Simulation& s = *started->s;
  open_energy_ledger(s);
  Course course;
  try {
    while (s.frame < n_frames) {
      run_frame(s, started->outputs);
      note_frame(s, course);
    }
  } catch (const SimulationError& error) {
    const std::string sentence = error.what();
    course.end = sentence.substr(0, sentence.find(';'));
  }
  note_balance(s);
  course.n_roll_backs = s.log.n_roll_backs;
  course.share_missing = balance_error(s).share;
  course.is_told = (course.n_roll_backs == 0 || is_told(s, "rolled back")) &&
                   (course.share_missing < .05 || is_told(s, "the energies do not add up"));
  return course;
}

std::string box_text(BoxElements elements, double half_width, double height,
                     const std::string& cells) {
  const std::string w = std::to_string(half_width);
  return std::string("[tissue.shape]\nkind = \"box\"\nelements = \"") +
         (elements == BoxElements::hex8 ? "hex8" : "tet4-kuhn") + "\"\nlow = [-" + w + ", -" + w +
         ", 0]\nhigh = [" + w + ", " + w + ", " + std::to_string(height) + "]\ncells = " + cells +
         "\n[tissue.material]\nyoung_modulus = 3000\npoisson_ratio = 0.45\ndensity = 1000\n";
}

std::string block_text(BoxElements elements) {
  return box_text(elements, side / 2, side, "[6, 6, 6]") + "[solver]\nmass_damping = 20\n";
}

std::string support(const std::string& region) {
  return "[[support]]\nregion = \"" + region + "\"\n";
}

// From above or from below (sign), its tip on the z axis. [s], [m]
struct TipKey {
  double time, z;
};
std::string probe_on_axis(double radius, int sign, std::initializer_list<TipKey> keys) {
  std::string text = "[[instrument]]\nkind = \"probe\"\nname = \"" +
                     std::string(sign > 0 ? "upper" : "lower") +
                     "\"\nlength = 0.05\nradius = " + std::to_string(radius) + "\npath = [\n";
  for (const TipKey& key : keys)
    text += "{ time = " + std::to_string(key.time) + ", position = [3e-4, 2e-4, " +
            std::to_string(key.z) + "], direction = [0, 0, " + std::to_string(-sign) +
            "], forward = [1, 0, 0] },\n";
  return text + "]\n";
}

StabilityRow row_of_release(const std::string& configuration, const Course& course) {
  const bool is_over = course.end.empty();
  const double left = course.stored / course.work;
  return {configuration, "comes back to rest (1e-3 of the work of contact left)",
          is_over ? text("%.1e of the work left", left) : course.end, is_over && left < 1e-3};
}

StabilityRow row_of_jump(const std::string& configuration, const Course& course) {
  const bool is_over = course.end.empty();
  const double left = std::abs(course.kinetic) / course.fastest;
  return {configuration,
          "comes to rest (1e-3 of the motion left); roll-backs and energy that is missing are told",
          is_over ? text("%.1e left; %d roll-backs, %.1f %% missing%s", left,
                         static_cast<int>(course.n_roll_backs), 100 * course.share_missing,
                         course.is_told ? "" : ", not told")
                  : course.end,
          is_over && left < 1e-3 && course.is_told};
}

}  // namespace

// Five layers of cells, on a floor or held at the rim. The ball meets them at 1 m/s, the speed of
// their shear waves, and stops 0.4 mm above the floor or goes 3 mm below the rim.
std::vector<StabilityRow> struck_layers(double) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const bool is_floor : {true, false})
      for (const int frame_rate : {2000, 60}) {
        const std::string scene =
            "[time]\nduration = 1\nframe_rate = " + std::to_string(frame_rate) + "\n" +
            box_text(elements, 4e-3, thickness, "[16, 16, 5]") +
            (is_floor ? support("z-")
                      : support("x-") + support("x+") + support("y-") + support("y+")) +
            probe_on_axis(.002, 1,
                          {{0, .021},
                           {.01, .011},
                           {.02, .001},
                           {is_floor ? .0206 : .023, is_floor ? 4e-4 : -2e-3},
                           {.04, is_floor ? 4e-4 : -2e-3}});
        const Course course = run_scene(scene, frame_rate / 30);
        rows.push_back(
            {text("%s, 5 layers of %.1f mm %s, struck by a ball at 1 m/s, %d frames/s",
                  name_of(elements), 1e3 * layer, is_floor ? "on a floor" : "held at the rim",
                  frame_rate),
             "outside of the ball to a tenth of a layer; the work of contact adds up to 2 %",
             course.end.empty() ? text("%.3f of a layer, %.2f %%", course.depth / layer,
                                       100 * course.miss / course.work)
                                : course.end,
             course.end.empty() && course.depth < .1 * layer && course.miss < .02 * course.work});
      }
  return rows;
}

// Two balls close on a sheet from both sides until nothing is left between them, and leave within
// 10 ms.
std::vector<StabilityRow> pinched_sheet(double) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both) {
    std::string scene = "[time]\nduration = 1\nframe_rate = 60\n" +
                        box_text(elements, 6e-3, 2 * thickness, "[12, 12, 4]") +
                        "[solver]\nmass_damping = 20\n" + support("x-") + support("x+");
    for (const int sign : {1, -1})
      scene += probe_on_axis(.003, sign,
                             {{0, thickness + sign * 1.2e-3},
                              {.2, thickness},
                              {.3, thickness},
                              {.31, thickness + sign * .02}});
    rows.push_back(row_of_release(
        text("%s, sheet of 2 mm pinched between two balls to no gap", name_of(elements)),
        run_scene(scene, 48)));
  }
  return rows;
}

// A ball that rests half a block deep.
std::vector<StabilityRow> withdrawn_ball(double) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const double milliseconds : {10., .1}) {
      const std::string scene = "[time]\nduration = 1\nframe_rate = 60\n" + block_text(elements) +
                                support("z-") +
                                probe_on_axis(.006, 1,
                                              {{0, side + .002},
                                               {.3, side / 2},
                                               {.4, side / 2},
                                               {.4 + 1e-3 * milliseconds, side / 2 + .065}});
      rows.push_back(row_of_release(text("%s, a ball half a block deep, withdrawn by 65 mm "
                                         "within %g ms",
                                         name_of(elements), milliseconds),
                                    run_scene(scene, 60)));
    }
  return rows;
}

// The top of a block, by a third of its height: in a step, and 30 times as fast as its waves.
std::vector<StabilityRow> jumping_support(double) {
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const char* direction : {"down", "up"}) {
      const std::string way = std::string(direction) == "down" ? "-0.01" : "0.01";
      const Course course =
          run_scene("[time]\nduration = 1\nframe_rate = 60\n" + block_text(elements) +
                        support("z-") + support("z+") +
                        "path = [{ time = 0.1, displacement = [0, 0, 0] }, { time = 0.1001, "
                        "displacement = [0, 0, " +
                        way + "] }]\n",
                    48);
      rows.push_back(row_of_jump(text("%s, top of a block moved %s by a third of its height within "
                                      "0.1 ms",
                                      name_of(elements), direction),
                                 course));
    }
  return rows;
}

// A pull at the top of a block within 0.1 ms: linear tissue would stretch to 1 + share times its
// length.
std::vector<StabilityRow> jumping_load(double) {
  struct Jump {
    double share;
    int frame_rate;
  };
  std::vector<StabilityRow> rows;
  for (const BoxElements elements : both)
    for (const Jump& jump : {Jump{1, 60}, Jump{3, 60}, Jump{3, 240}, Jump{10, 240}}) {
      const double EA = 3000 * side * side;
      const Course course = run_scene(
          "[time]\nduration = 1\nframe_rate = " + std::to_string(jump.frame_rate) + "\n" +
              block_text(elements) + support("z-") + "[[load]]\nregion = \"z+\"\nforce = [0, 0, " +
              std::to_string(jump.share * EA) +
              "]\npath = [{ time = 0.1, factor = 0 }, { time = 0.1001, factor = 1 }]\n",
          4 * jump.frame_rate / 5);
      rows.push_back(row_of_jump(text("%s, block pulled by %g E A within 0.1 ms, %d frames/s",
                                      name_of(elements), jump.share, jump.frame_rate),
                                 course));
    }
  return rows;
}

}  // namespace trocar
