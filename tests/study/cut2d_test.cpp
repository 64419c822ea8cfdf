// What `trocar cut2d` reads, measures, prints and draws.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "cutting/cut_plane_paper.h"
#include "study/cut2d_json.h"
#include "study/cut2d_path.h"
#include "study/cut2d_picture.h"

namespace trocar {
namespace {

std::size_t n_found(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Cut2dPath, points_are_read_in_millimetres) {
  const Cut2dPath path = read_path(" 17.8,35.2  41.6,-18 41.6,-18");
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0], Vec3(17.8 * 1e-3, 35.2 * 1e-3, 0));
  EXPECT_EQ(path[1], Vec3(41.6 * 1e-3, -18 * 1e-3, 0));
}

TEST(Cut2dPath, what_is_no_path_is_an_input_error) {
  for (const char* text : {"", "1,2", "1,2 3", "1,2 3,4,5", "1,2 3,nan", "1,2 x,4", "1,2 1,2"})
    EXPECT_THROW(read_path(text), InputError) << text;
  EXPECT_THROW(read_arc("1,2 3,4"), InputError);
  EXPECT_THROW(read_arc("1,2 3,4 1,2"), InputError);
}

// Through (5, 0), (3, 4), (-3, 4): circle of radius 5 around the origin; and back.
TEST(Cut2dPath, arc_keeps_its_distance_from_the_centre) {
  for (const char* text : {"5,0 3,4 -3,4", "-3,4 3,4 5,0", "5,0 -3,4 3,-4"}) {
    const Cut2dPath arc = read_arc(text);
    EXPECT_EQ(arc.size(), 65u);
    for (const Vec3& X : arc) EXPECT_NEAR(X.norm(), 5e-3, 1e-15) << text;
    // 64 chords of an arc of at most 2 pi: none longer than 2 pi R / 32.
    for (std::size_t k = 1; k < arc.size(); ++k)
      EXPECT_LT((arc[k] - arc[k - 1]).norm(), 5e-3 * 6.2832 / 32) << text;
  }
}

// In one edit these opened 1, 12 and 9 edges in the robust mode.
TEST(Cut2dTrial, sharp_bend_takes_no_edges_from_its_legs) {
  const auto edges = [](int configuration, const std::string& path) {
    const Cut2dTrial trial = run_trial(paper_mesh(configuration), {read_path(path)},
                                       options_of(Cut2dMode::robust, 1, 0));
    EXPECT_EQ(trial.figures.n_refused, 0) << path;
    return trial.figures.n_opened_facets;
  };
  const auto of_bend = [&](int configuration, const std::string& from, const std::string& bend,
                           const std::string& to) {
    const int legs =
        edges(configuration, from + " " + bend) + edges(configuration, bend + " " + to);
    EXPECT_GE(edges(configuration, from + " " + bend + " " + to), legs - 2) << configuration;
  };
  of_bend(3, "45,15", "20,20", "45,25");
  of_bend(2, "60,8", "20,30", "60,20");
  of_bend(4, "50,10", "20,22", "30,10");
}

// 20 degrees: the elements between the legs are as thin as the wedge is, so that its tip stays.
TEST(Cut2dTrial, thin_wedge_keeps_the_floor_and_says_where_it_stays_joined) {
  const std::vector<Cut2dPath> path = {read_path("60,8 20,30 60,20")};
  const Cut2dTrial free = run_trial(paper_mesh(2), path, options_of(Cut2dMode::robust, 1, 0));
  EXPECT_LT(free.step_ratio, 0.5);
  EXPECT_TRUE(free.figures.refusals.empty());
  const Cut2dTrial trial = run_trial(paper_mesh(2), path, options_of(Cut2dMode::robust, 1));
  EXPECT_GE(trial.step_ratio, 0.5);
  EXPECT_GE(trial.figures.n_opened_facets, free.figures.n_opened_facets - 2);
  ASSERT_EQ(trial.figures.refusals.size(), 1);
  EXPECT_EQ(trial.figures.refusals[0].reason, CutRefusal::slow);
  EXPECT_LT((trial.figures.refusals[0].X - path[0][1]).norm(), 8 * mm);
}

TEST(Cut2dTrial, path_that_crosses_itself_is_cut_whole) {
  const Cut2dTrial trial =
      run_trial(paper_mesh(2), {read_path("-1,12 35,12 45,18 45,26 35,31 28,26 28,-1")},
                options_of(Cut2dMode::robust, 1));
  EXPECT_EQ(trial.figures.n_refused, 0);
  EXPECT_EQ(trial.n_new_elements, 0);
  // Euler of three pieces: the corner, what is inside the loop, and the rest.
  EXPECT_EQ(trial.n_new_nodes, trial.figures.n_opened_facets + 2);
  EXPECT_GT(trial.altitude_ratio, 0.2);
}

TEST(Cut2dTrial, several_paths_are_cut_one_after_another) {
  const std::vector<Cut2dPath> paths = {read_path("30,-1 38,41"), read_path("-1,17 71,23")};
  const Cut2dTrial trial = run_trial(paper_mesh(2), paths, options_of(Cut2dMode::robust, 1));
  EXPECT_EQ(trial.figures.n_refused, 0);
  EXPECT_EQ(trial.n_new_elements, 0);
  // The first cut of n edges adds n + 1 nodes, the second meets it: two chains of n1 and n2 edges
  // add n1 + 1 and n2 + 1.
  EXPECT_EQ(trial.n_new_nodes, trial.figures.n_opened_facets + 3);
}

// Nothing is cut twice, and nothing told as joined that is open.
TEST(Cut2dTrial, path_that_begins_or_stays_in_an_older_slit_goes_on_from_it) {
  const auto trial_of = [](const std::vector<Cut2dPath>& paths) {
    return run_trial(paper_mesh(2), paths, options_of(Cut2dMode::robust, 1, 0));
  };
  const Cut2dPath whole = read_path("-1,20 71,20"), first = read_path("-1,20 40,20");
  const int n_whole = trial_of({whole}).figures.n_opened_facets,
            n_first = trial_of({first}).figures.n_opened_facets;
  for (const char* rest : {"38,20 71,20", "20,20 71,20", "71,20 20,20"}) {
    const Cut2dTrial trial = trial_of({first, read_path(rest)});
    EXPECT_NEAR(trial.figures.n_opened_facets, n_whole, 1) << rest;
    EXPECT_EQ(trial.figures.n_refused, 0) << rest;
  }
  EXPECT_LT(n_first, n_whole - 5);
  for (const char* again : {"-1,20 71,20", "20,20 50,20"}) {
    const Cut2dTrial trial = trial_of({whole, read_path(again)});
    EXPECT_EQ(trial.figures.n_opened_facets, n_whole) << again;
    EXPECT_EQ(trial.figures.n_refused, 0) << again;
  }
}

TEST(Cut2dTrial, repetitions_change_nothing_but_times) {
  const std::vector<Cut2dPath> paths = {paper_cut(1)};
  const Cut2dTrial once = run_trial(paper_mesh(1), paths, options_of(Cut2dMode::paper, 1));
  const Cut2dTrial thrice = run_trial(paper_mesh(1), paths, options_of(Cut2dMode::paper, 3));
  EXPECT_EQ(once.after.X, thrice.after.X);
  EXPECT_EQ(once.figures.n_opened_facets, thrice.figures.n_opened_facets);
  EXPECT_GT(thrice.best_seconds, 0);
  EXPECT_LE(thrice.best_seconds, thrice.median_seconds);
}

TEST(Cut2dTrial, subdivision_along_a_bend_is_an_input_error) {
  EXPECT_THROW(run_trial(paper_mesh(1), {read_path("10,10 20,20 30,10")},
                         options_of(Cut2dMode::subdivision, 1)),
               InputError);
}

// 14 printed rows, 6 of ours for I, 2 for OR, 2 x 6 for NR; 2 lines of heads, an empty line a mesh.
TEST(Cut2dTable, has_all_rows_and_aligned_columns) {
  const std::vector<Cut2dRow> rows = paper_rows(1);
  EXPECT_EQ(rows.size(), 14u + 6 + 2 + 2 * 6);
  const std::string text = rows_text(rows);
  EXPECT_EQ(n_found(text, "\n"), rows.size() + 2 + n_paper_configurations);
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const std::size_t bar = line.find('|');
  while (std::getline(lines, line)) {
    if (line.empty()) continue;
    EXPECT_EQ(line.find('|'), bar) << line;
  }
  EXPECT_EQ(n_found(rows_markdown(rows), "\n"), rows.size() + 2);
}

TEST(Cut2dTable, marks_digits_that_differ_from_the_printed_ones) {
  PlaneStatistics printed;
  printed.n_nodes = 80;
  printed.area.min = 22.22;
  PlaneStatistics ours = printed;
  ours.area.min = 22.2249;  // prints as 22.22
  Cut2dRow first{1, "I", "printed", printed, 0, 0, ""}, second{1, "I", "ours", ours, 0, 0, ""};
  EXPECT_EQ(n_found(rows_text({first, second}), "80#"), 0u);
  EXPECT_EQ(n_found(rows_text({first, second}), "22.22#"), 0u);
  second.statistics.n_nodes = 81;
  EXPECT_EQ(n_found(rows_text({first, second}), "81#"), 1u);
}

TEST(Cut2dTrial, repeats_for_a_quarter_of_a_second_if_not_told_how_often) {
  const auto trial = [](int repetitions) {
    return run_trial(paper_mesh(1), {paper_cut(1)}, options_of(Cut2dMode::robust, repetitions));
  };
  const auto start = std::chrono::steady_clock::now();
  const Cut2dTrial open = trial(0), one = trial(1);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_GE(seconds.count(), 0.25);  // one alone takes milliseconds
  EXPECT_LE(open.best_seconds, open.median_seconds);
  EXPECT_EQ(one.best_seconds, one.median_seconds);
  EXPECT_EQ(open.after.X, one.after.X);
}

TEST(Cut2dJson, says_what_the_cut_did) {
  const Cut2dTrial trial =
      run_trial(paper_mesh(1), {paper_cut(1)}, options_of(Cut2dMode::robust, 1));
  const auto json = nlohmann::json::parse(trial_json(trial, "robust"));
  EXPECT_EQ(json["after"]["n_nodes"], 85);
  EXPECT_EQ(json["n_new_nodes"], 5);
  EXPECT_EQ(json["n_refused"], 0);
  EXPECT_EQ(nlohmann::json::parse(rows_json(paper_rows(1))).size(), 34u);
}

// Euler: N - E + F = 1 with F = 126 triangles and 80 nodes gives 205 edges; the 6 edges of the cut
// are two each once it is open. 6 edges join 7 nodes.
TEST(Cut2dPicture, draws_each_edge_once_and_both_sides_of_the_cut) {
  const Mesh mesh = paper_mesh(1);
  EXPECT_EQ(n_found(mesh_svg(mesh, {paper_cut(1)}, "before"), "<line"), 205u);
  EXPECT_EQ(n_found(mesh_svg(mesh, {paper_cut(1)}, "before"), "<polyline"), 1u);
  const Cut2dTrial trial = run_trial(mesh, {paper_cut(1)}, options_of(Cut2dMode::robust, 1));
  const std::string after = mesh_svg(trial.after, {}, "after");
  EXPECT_EQ(n_found(after, "<line"), 205u + 6);
  EXPECT_EQ(n_found(after, "<circle"), 7u);
}

}  // namespace
}  // namespace trocar
