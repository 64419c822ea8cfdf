#include "engine/cut_stage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "engine/simulation.h"
#include "engine_plate.h"
#include "engine_started.h"
#include "scene_plate.h"

namespace trocar {
namespace {

struct Slit {
  int n_opened = 0;
  double length = 0;  // in the undeformed plate [m]
};
Slit slit_along(const std::vector<std::pair<double, double>>& points) {
  const auto started = built(plate_text(points));
  Simulation& s = *started->s;
  for (int frame = 0; frame < 60; ++frame) run_frame(s, started->outputs);
  Slit slit;
  for (const CutRecord& stroke : s.cuts[0].strokes) slit.n_opened += stroke.figures.n_opened_facets;
  const Mesh& mesh = s.mesh;
  for (std::int32_t e = 0; e < mesh.n_elements(); ++e)
    for (int f = 0; f < 3; ++f) {
      if ((mesh.cut_facets[e] >> f & 1) == 0) continue;
      const auto corner = facet_corners(ElementType::tri3, f);
      const auto X = [&](int a) { return mesh.X[mesh.corners(e)[a]]; };
      slit.length += 0.5 * (X(corner[0]) - X(corner[1])).norm();  // both lips have it
    }
  return slit;
}

// The first blade has halved the step of hexahedra before the second one begins.
TEST(CutStage, stroke_keeps_its_own_step_when_another_blade_begins) {
  const std::string scalpel = "[[instrument]]\nkind = \"scalpel\"\n";
  const auto started = built(
      "[time]\nduration = 4\n[tissue.shape]\nkind = \"box\"\nelements = \"hex8\"\n"
      "high = [0.04, 0.03, 0.01]\ncells = [8, 6, 2]\n[solver]\nmass_damping = 20\n"
      "[[support]]\nregion = \"z-\"\n" +
      scalpel + "path = [\n" + facing(key(0.1, -5, 9.3, 4) + key(1.1, 45, 9.3, 4), "[1, 0.3, 0]") +
      "]\n" + scalpel + "name = \"second\"\npath = [\n" +
      facing(key(0.5, 30, 40, 4) + key(1, 30, 22, 4), "[0, -1, 0]") + "]\n");
  Simulation& s = *started->s;
  const auto run_until = [&](const std::function<bool()>& is_reached) {
    while (!is_reached() && s.frame < 60) run_frame(s, started->outputs);
    return is_reached();
  };
  ASSERT_TRUE(run_until([&] { return !s.cuts[1].strokes.empty(); }));
  ASSERT_TRUE(s.cuts[0].is_in_stroke);
  const CutRecord before = s.cuts[0].strokes[0];
  EXPECT_LT(before.scene_step_ratio, 0.8);
  ASSERT_TRUE(run_until([&] { return s.cuts[0].strokes[0].n_edits > before.n_edits; }));
  EXPECT_NEAR(s.cuts[0].strokes[0].scene_step_ratio, before.scene_step_ratio, 0.1);
}

// In one edit these opened 6 (of 12), 13 and 14.
TEST(CutStage, sharp_bend_takes_no_edges_from_its_legs) {
  const std::pair<double, double> from{45, 14}, bend{24, 16}, to{45, 22};
  const double legs = std::hypot(21, 2) + std::hypot(21, 6);
  EXPECT_NEAR(slit_along({from, bend, to}).length, 1e-3 * legs, 1e-5 * legs);
  const auto check = [](double end) {
    const std::pair<double, double> a{45, 14}, b{18, 16}, c{45, end};
    EXPECT_GE(slit_along({a, b, c}).n_opened,
              slit_along({a, b}).n_opened + slit_along({b, c}).n_opened)
        << end;
  };
  check(30);
  check(26);
}

// What is left of the strokes of a scalpel with a blade of 30 mm that goes from one place to the
// other [m] from 0.1 s on; `tissue` is held at a region.
struct Cut {
  std::int32_t n_pieces = 0;
  std::int64_t n_opened = 0, n_refused = 0;
  bool goes_through = false;  // the last stroke
};
Cut cut_along(const std::string& tissue, const std::string& from, const std::string& to,
              double seconds, const std::string& direction, const std::string& held = "z-") {
  const auto key = [&](double time, const std::string& position) {
    return "{ time = " + std::to_string(time) + ", position = [" + position +
           "], direction = " + direction + ", forward = [1, 0, 0] },\n";
  };
  const auto started =
      built("[time]\nduration = 1\nframe_rate = 30\n" + tissue +
            "[tissue.material]\nyoung_modulus = 5000\n[solver]\nmass_damping = 15\n[[support]]\n"
            "region = \"" +
            held + "\"\n[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.03\npath = [\n" +
            key(0.1, from) + key(0.1 + seconds, to) + "]\n");
  Simulation& s = *started->s;
  for (int frame = 0; frame < 18; ++frame) run_frame(s, started->outputs);
  Cut cut{.n_pieces = s.n_pieces};
  for (const CutRecord& stroke : s.cuts[0].strokes) {
    cut.n_opened += stroke.figures.n_opened_facets;
    cut.n_refused += stroke.figures.n_refused;
    cut.goes_through = stroke.figures.goes_through;
  }
  return cut;
}

std::string tet_box(const std::string& low, const std::string& high, const std::string& cells) {
  return "[tissue.shape]\nkind = \"box\"\nelements = \"tet4-kuhn\"\nlow = [" + low + "]\nhigh = [" +
         high + "]\ncells = [" + cells + "]\n";
}

// 60 mm in so many seconds, from 0.2 to 1.2 m/s: a column of 8 mm is left behind within a frame.
TEST(CutStage, cuts_what_the_blade_passes_between_two_frames) {
  const std::string column = tet_box("-0.004, -0.004, 0", "0.004, 0.004, 0.04", "3, 3, 15");
  for (const double seconds : {0.3, 0.21, 0.12, 0.07, 0.05}) {
    const Cut cut =
        cut_along(column, "-0.03, -0.015, 0.02", "0.03, -0.015, 0.021", seconds, "[0, -1, 0]");
    EXPECT_EQ(cut.n_pieces, 2) << seconds;
    EXPECT_EQ(cut.n_refused, 0) << seconds;
    EXPECT_TRUE(cut.goes_through) << seconds;
  }
  // Where the blade's tip passes through the tissue the cut ends there, as meant.
  const std::string sheet = tet_box("-0.002, -0.02, 0", "0.002, 0.02, 0.04", "2, 20, 20");
  const Cut notch = cut_along(sheet, "-0.03, 0, 0.02", "0.03, 0, 0.02", 0.05, "[0, 0, -1]");
  EXPECT_EQ(notch.n_pieces, 1);
  EXPECT_GT(notch.n_opened, 20);
  EXPECT_FALSE(notch.goes_through);
  EXPECT_EQ(notch.n_refused, 0);
}

TEST(CutStage, cuts_a_membrane_between_the_points_of_the_edge) {
  const std::string membrane = tet_box("-0.03, -0.01, 0", "0.03, 0.01, 0.0003", "30, 10, 1");
  for (const double tip : {-0.0116, -0.0108}) {
    const std::string y_z = ", 0, " + std::to_string(tip);
    const Cut cut = cut_along(membrane, "-0.035" + y_z, "0.035" + y_z, 0.3, "[0, 0, -1]");
    EXPECT_EQ(cut.n_pieces, 2) << tip;
  }
}

TEST(CutStage, cuts_a_plate_that_its_tip_passes_between_two_frames) {
  const std::string plate =
      "[tissue]\nthickness = 0.005\n[tissue.shape]\nkind = \"rectangle\"\nhigh = [0.03, 0.02, 0]\n"
      "cells = [12, 8, 1]\n";
  const Cut cut = cut_along(plate, "0.014, -0.02, 0", "0.016, 0.04, 0", 0.03, "[0, 0, -1]", "x-");
  EXPECT_EQ(cut.n_pieces, 2);
}

// Across and, lifted in between, upwards, 5 mm aside on its way. Reaches of the path end anywhere
// beside the slit.
TEST(CutStage, crosses_its_own_slit_in_a_plate) {
  std::string corners;
  for (const std::string low :
       {"[-1, -1, -1]", "[0.057, -1, -1]", "[-1, 0.049, -1]", "[0.057, 0.049, -1]"}) {
    const std::string high = std::string(contains(low, "[0.057") ? "[1, " : "[0.003, ") +
                             (contains(low, " 0.049") ? "1, 1]" : "0.003, 1]");
    const std::string name = "\"corner" + std::to_string(corners.size()) + "\"\n";
    corners += "[[region]]\nname = " + name + "low = " + low + "\nhigh = " + high +
               "\n[[support]]\nregion = " + name;
  }
  for (const double x : {25.0, 28.0, 30.0, 31.5, 32.8}) {
    const std::string way = key(0.05, -5, 20, 0) + key(0.6, 65, 30, 0) + key(0.7, 65, 30, 20);
    const std::string then = key(0.9, x, -6, 20) + key(1, x, -6, 0) + key(1.8, x - 5, 65, 0);
    const auto started = built(
        "[time]\nduration = 2\nframe_rate = 30\n[tissue]\nthickness = 0.005\n[tissue.shape]\n"
        "kind = \"triangular-rectangle\"\nhigh = [0.06, 0.052, 0]\ncells = [25, 26, 1]\n"
        "[tissue.material]\nyoung_modulus = 6000\npoisson_ratio = 0.4\n[solver]\nmass_damping = "
        "20\n"
        "[cutting]\nresistance = 0\n" +
        corners +
        "[[instrument]]\nkind = \"scalpel\"\nradius = 0.001\nblade_length = 0.008\npath = [\n" +
        facing(way, "[1, 0, 0]") + facing(then, "[0, 1, 0]") + "]\n");
    Simulation& s = *started->s;
    while (s.frame < 56) run_frame(s, started->outputs);
    EXPECT_EQ(s.n_pieces, 4) << x;
    for (const CutRecord& stroke : s.cuts[0].strokes) EXPECT_EQ(stroke.figures.n_refused, 0) << x;
  }
}

// Half of its 5 mm lies above z = 0. A blade of 20 mm that hangs down farther goes through it
// higher up.
TEST(CutStage, cuts_a_plate_at_every_depth_of_its_tip_within_or_below_it) {
  const auto n_cut = [](double z) {
    std::string text = plate_text({{30, -3}, {30, 43}});
    const std::string height = "\"0.000000 mm\"], direction";
    for (std::size_t at = text.find(height); at != std::string::npos;
         at = text.find(height, at + 1))
      text.replace(at + 1, 8, std::to_string(z));
    const auto started = built(text);
    Simulation& s = *started->s;
    while (s.frame < 66) run_frame(s, started->outputs);
    return s.n_pieces;
  };
  for (const double z : {0.0, 1e-6, 0.5, -0.5, 2.4, -2.4, -6.0, -19.0}) EXPECT_EQ(n_cut(z), 2) << z;
  for (const double z : {2.6, 6.0, -23.0}) EXPECT_EQ(n_cut(z), 1) << z;
}

// 60 mm between tissue that supports move at both ends and a blade of 40 mm, in 0.6 s; `share`: the
// blade's part of the motion.
struct Meeting {
  std::int32_t n_pieces = 0;
  std::int64_t n_refused = 0, n_edits = 0, n_askew = 0;
  double largest_force = 0;
};
Meeting meet(const std::string& tissue, double share, double resistance, double tip) {
  const double end = 0.03 - share * 0.06;
  const std::string way =
      "path = [{ time = 0.1, displacement = [0, 0, 0] }, { time = 0.7, "
      "displacement = [" +
      std::to_string(0.06 * (1 - share)) + ", 0, 0] }]\n";
  const auto key = [&](double time, double x) {
    return "{ time = " + std::to_string(time) + ", position = [" + std::to_string(x) +
           ", 0.0213, " + std::to_string(tip) + "], forward = [-1, 0, 0] },\n";
  };
  const auto started =
      built("[time]\nduration = 0.9\nframe_rate = 30\n" + tissue +
            "[tissue.material]\nyoung_modulus = 40000\n[solver]\nmass_damping = 20\n[cutting]\n"
            "resistance = " +
            std::to_string(resistance) + "\n[[support]]\nregion = \"y-\"\n" + way +
            "[[support]]\nregion = \"y+\"\n" + way +
            "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.04\npath = [\n" + key(0.1, 0.03) +
            key(0.7, end) + "]\n");
  Simulation& s = *started->s;
  Meeting meeting;
  while (s.frame < 27) {
    run_frame(s, started->outputs);
    meeting.largest_force =
        std::max(meeting.largest_force, s.log.rows.back().tools[0].force.norm());
  }
  meeting.n_pieces = s.n_pieces;
  for (const CutRecord& stroke : s.cuts[0].strokes) {
    meeting.n_refused += stroke.figures.n_refused;
    meeting.n_edits += stroke.n_edits;
    meeting.n_askew += stroke.n_askew;
  }
  return meeting;
}

// The blade goes through all of a bar of 8 x 24 x 10 mm.
TEST(CutStage, cuts_what_moves_onto_the_blade_as_what_the_blade_moves_into) {
  const std::string bar = tet_box("-0.004, 0.008, 0", "0.004, 0.032, 0.01", "4, 12, 5");
  for (const double share : {1.0, 0.5, 0.0, -1.0}) {
    const Meeting meeting = meet(bar, share, 20, -0.005);
    EXPECT_EQ(meeting.n_pieces, 2) << share;
    EXPECT_EQ(meeting.n_refused, 0) << share;
    EXPECT_EQ(meeting.n_askew, 0) << share;
    // 10 mm of edge inside; the blade's flat sides and the tissue's stretch take some.
    EXPECT_NEAR(meeting.largest_force, 20 * 0.01, 0.2 * 20 * 0.01) << share;
  }
}

TEST(CutStage, cuts_a_plate_that_moves_onto_the_blade) {
  const std::string plate =
      "[tissue]\nthickness = 0.005\n[tissue.shape]\nkind = \"triangular-rectangle\"\n"
      "high = [0.02, 0.04, 0]\ncells = [9, 19, 1]\n";
  for (const double share : {1.0, 0.5, 0.0}) {
    const Meeting meeting = meet(plate, share, 0, 0);
    EXPECT_EQ(meeting.n_pieces, 2) << share;
    EXPECT_EQ(meeting.n_refused, 0) << share;
  }
}

TEST(CutStage, leaves_tissue_at_rest_alone_around_a_blade_at_rest) {
  const auto started =
      built("[time]\nduration = 1\nframe_rate = 30\n" +
            tet_box("-0.004, -0.012, 0", "0.004, 0.012, 0.01", "4, 12, 5") +
            "[cutting]\nresistance = 20\n[[support]]\nregion = \"y-\"\n[[instrument]]\nkind = "
            "\"scalpel\"\nblade_length = 0.04\npath = [{ time = 0, position = [0.001, 0.0013, "
            "-0.005], forward = [-1, 0, 0] }]\n");
  Simulation& s = *started->s;
  while (s.frame < 20) run_frame(s, started->outputs);
  for (const CutRecord& stroke : s.cuts[0].strokes) EXPECT_EQ(stroke.n_edits, 0);
  for (const ToolRow& row : s.log.rows.back().tools) EXPECT_LT(row.force.norm(), 1e-9);
}

// It cuts all the same, and says so.
TEST(CutStage, tells_of_a_scalpel_whose_edge_does_not_face_its_way) {
  for (const std::string forward : {"[0, 1, 0]", "[0.8, 0.6, 0]", "[1, 0, 0]", "[0, -1, 0]"}) {
    const auto started = built(facing(plate_text({{30, -3}, {30, 20}}), forward));
    Simulation& s = *started->s;
    for (int frame = 0; frame < 45; ++frame) run_frame(s, started->outputs);
    const CutRecord& stroke = s.cuts[0].strokes.at(0);
    ASSERT_GT(stroke.n_edits, 0) << forward;
    const bool is_askew = forward != "[0, 1, 0]" && forward != "[0.8, 0.6, 0]";
    EXPECT_EQ(stroke.n_askew > 0, is_askew) << forward;
    const auto is_told = [](const std::string& event) {
      return contains(event, "turned by more than 60 degrees from its way");
    };
    EXPECT_EQ(std::ranges::count_if(s.log.events, is_told), is_askew ? 1 : 0) << forward;
  }
}

// The tissue is parted ahead of the blade's front on its way back, too: nothing of that is wrong.
TEST(CutStage, has_nothing_to_tell_of_a_scalpel_that_draws_back_in_its_slit) {
  for (const std::string elements : {"tet4-kuhn", "tet4-five", "hex8"}) {
    const auto block =
        built(plate_of(elements) + "[[support]]\nregion = \"x+\"\n" + scalpel_along("40 mm", R"(
  { time = 0.1, position = ["3 mm", "-10 mm", "-10 mm"], forward = [0, 1, 0] },
  { time = 0.4, position = ["3 mm", "11 mm", "-10 mm"], forward = [0, 1, 0] },
  { time = 0.7, position = ["3 mm", "-10 mm", "-10 mm"], forward = [0, 1, 0] },
)"));
    Simulation& s = *block->s;
    while (s.frame < 48) run_frame(s, block->outputs);
    ASSERT_FALSE(s.cuts[0].strokes.empty());
    EXPECT_GT(s.cuts[0].strokes[0].figures.n_opened_facets, 0);
    for (const CutRecord& stroke : s.cuts[0].strokes) {
      EXPECT_EQ(stroke.figures.n_refused, 0) << elements;
      EXPECT_EQ(stroke.n_askew, 0) << elements;
    }
    for (const std::string& event : s.log.events) EXPECT_FALSE(contains(event, "scalpel")) << event;
  }
}

// There and back in a plate one element thick: two strokes, each told at its end.
TEST(CutStage, tells_at_the_end_of_a_stroke_how_much_it_leaves_joined) {
  const auto plate =
      built(plate_of("tet4-five") + "[[support]]\nregion = \"x+\"\n" + scalpel_along("60 mm", R"(
  { time = 0.02, position = ["-45 mm", "26 mm", "2.1 mm"], direction = [0, 1, 0] },
  { time = 0.3, position = ["45 mm", "26 mm", "2.3 mm"], direction = [0, 1, 0] },
  { time = 0.5, position = ["45 mm", "26 mm", "2.9 mm"], direction = [0, 1, 0] },
  { time = 0.8, position = ["-45 mm", "26 mm", "2.9 mm"], direction = [0, 1, 0] },
)"),
            {"cutting.split_step_ratio=0", "solver.gravity=[0,0,-0.05]"});
  Simulation& s = *plate->s;
  const auto n_told = [&] {
    return std::ranges::count_if(s.log.events, [](const std::string& event) {
      return contains(event, "scalpel leaves tissue joined in ");
    });
  };
  int n_refused_strokes = 0;
  while (s.frame < 45) {
    run_frame(s, plate->outputs);
    n_refused_strokes = 0;
    for (const CutRecord& stroke : s.cuts[0].strokes) {
      const bool has_ended = &stroke != &s.cuts[0].strokes.back() || !s.cuts[0].is_in_stroke;
      n_refused_strokes += has_ended && stroke.figures.n_refused > 0 ? 1 : 0;
    }
    EXPECT_EQ(n_told(), n_refused_strokes) << s.frame;
  }
  ASSERT_GT(n_refused_strokes, 0);
  const CutRecord& first = s.cuts[0].strokes[0];
  ASSERT_GT(first.figures.n_refused, 1);
  const auto event = std::ranges::find_if(
      s.log.events, [](const std::string& e) { return contains(e, "leaves tissue joined"); });
  EXPECT_TRUE(
      contains(*event, std::to_string(first.figures.n_refused) + " places, the first at ("));
  EXPECT_TRUE(contains(*event, reason_of(first.figures.refusals[0]))) << *event;
}

// 15 mm behind the first one, at once with it, and 0.4 mm beside its slit.
TEST(CutStage, second_scalpel_opens_no_slit_beside_that_of_the_first) {
  const auto scalpel = [](double start, double x) {
    return "[[instrument]]\nkind = \"scalpel\"\nblade_length = 0.02\nradius = 0.001\nname = "
           "\"from " +
           std::to_string(start + x) + "\"\npath = [\n" +
           facing(key(start, x, -6, 3) + key(start + 0.8, x, 36, 3), "[0, 1, 0]") + "]\n";
  };
  const std::string body =
      "[time]\nduration = 2\nframe_rate = 60\n[tissue.shape]\nkind = \"box\"\nelements = "
      "\"tet4-kuhn\"\nhigh = [0.06, 0.03, 0.012]\ncells = [20, 10, 4]\n[tissue.material]\n"
      "young_modulus = 6000\npoisson_ratio = 0.4\n[solver]\nmass_damping = 20\n"
      "[[support]]\nregion = \"x-\"\n[[support]]\nregion = \"x+\"\n";
  const std::array<std::array<double, 3>, 3> cases{{{30, 0.3, 0}, {31.1, 0, 0}, {30, 0.3, 0.4}}};
  for (const auto& [x, later, aside] : cases) {
    const auto started = built(body + scalpel(0.1, x) + scalpel(0.1 + later, x + aside + 1e-3));
    Simulation& s = *started->s;
    while (s.frame < 54 + 60 * later) run_frame(s, started->outputs);
    std::int64_t n_first = 0, n_second = 0;
    for (const CutRecord& stroke : s.cuts[0].strokes) n_first += stroke.figures.n_opened_facets;
    for (const CutRecord& stroke : s.cuts[1].strokes) n_second += stroke.figures.n_opened_facets;
    EXPECT_GT(n_first, 40) << x << ' ' << later;
    EXPECT_LE(n_second, n_first / 5) << x << ' ' << later << ' ' << aside;
  }
}

}  // namespace
}  // namespace trocar
