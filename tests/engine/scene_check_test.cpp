// What load_scene refuses beyond what a key alone can tell: each sentence names the place and what
// would be right.
#include <gtest/gtest.h>

#include <sstream>

#include "engine_scene.h"
#include "mesh/generate.h"

namespace trocar {
namespace {

void expect_error(const std::string& more, const std::string& sentence) {
  EXPECT_EQ(scene_error(scene_text()), "");
  const std::string found = scene_error(scene_text(more));
  EXPECT_TRUE(contains(found, sentence)) << "looked for: " << sentence << "\nfound: " << found;
  EXPECT_TRUE(contains(found, "s.toml:")) << found;
}

TEST(SceneCheck, takes_the_least_scene) {
  const Scene scene = load_scene_text(scene_text());
  EXPECT_EQ(scene.time.duration, 1);
  EXPECT_TRUE(scene.tissue.shape.has_value());
}

TEST(SceneCheck, knows_the_folder_that_mesh_files_are_relative_to) {
  const TestFolder folder;
  const std::string file = write_text(folder.file("s.toml"), scene_text());
  EXPECT_EQ(load_scene(file, {}).folder, folder.path() + "/");
}

TEST(SceneCheck, needs_a_mesh_or_a_shape_and_not_both) {
  const std::string time = "[time]\nduration = 1\n";
  EXPECT_TRUE(contains(scene_error(time + "[tissue]\nthickness = 1\n"), "exactly one of them"));
  EXPECT_TRUE(
      contains(scene_error(time + "[tissue]\nmesh = \"m.msh\"\n[tissue.shape]\nkind = \"ball\"\n"),
               "exactly one of them"));
  const TestFolder folder;
  const std::string mesh = write_text(folder.file("m.msh"), "");
  EXPECT_EQ(scene_error(time + "[tissue]\nmesh = \"" + mesh + "\"\n"), "");
}

TEST(SceneCheck, needs_files_that_are_there) {
  const std::string gone = scene_error("[time]\nduration = 1\n[tissue]\nmesh = \"gone.msh\"\n");
  EXPECT_TRUE(contains(gone, "gone.msh: there is no file of this name")) << gone;
  expect_error(instrument_text("probe") + "mesh = \"gone.stl\"\n",
               "gone.stl: there is no file of this name");
  expect_error(instrument_text("probe") + "mesh = \"/tmp\"\n", "/tmp: is a directory");
}

TEST(SceneCheck, needs_a_box_with_its_low_corner_below_the_high_one) {
  expect_error("low = [0, 0, 0]\nhigh = [1, 1, 0]\n",
               "each component of low must be below that of high");
  expect_error("low = [0, 2, 0]\nhigh = [1, 1, 1]\n",
               "each component of low must be below that of high");
}

TEST(SceneCheck, needs_a_plane_body_with_its_corner_beyond_the_origin) {
  const auto plane = [](const std::string& kind, const std::string& high) {
    return scene_error("[time]\nduration = 1\n[tissue.shape]\nkind = \"" + kind +
                       "\"\nhigh = " + high + "\n");
  };
  for (const std::string high : {"[1, 0, 0]", "[-1, 1, 0]"})
    EXPECT_TRUE(contains(plane("rectangle", high), "x and y must be > 0")) << high;
  EXPECT_TRUE(contains(plane("triangular-rectangle", "[0, 1, 0]"), "must be > 0"));
  EXPECT_EQ(plane("rectangle", "[1, 1, 0]"), "");
  EXPECT_EQ(plane("triangular-rectangle", "[1, 0, 0]"), "");
}

TEST(SceneCheck, needs_at_least_one_frame_and_at_most_ten_million) {
  const std::string tissue = "[tissue.shape]\nkind = \"box\"\n";
  EXPECT_TRUE(contains(scene_error("[time]\nduration = 0.03\nframe_rate = 30\n" + tissue),
                       "shorter than one frame"));
  EXPECT_TRUE(contains(scene_error("[time]\nduration = 2000\nframe_rate = 10000\n" + tissue),
                       "10 million"));
  EXPECT_EQ(scene_error("[time]\nduration = 0.1\nframe_rate = 10\n" + tissue), "");
  EXPECT_EQ(scene_error("[time]\nduration = 1000\nframe_rate = 10000\n" + tissue), "");
}

TEST(SceneCheck, needs_components_of_a_support_to_be_letters_of_xyz_each_once) {
  for (const std::string fix : {"", "xx", "xyzx", "a", "x y", "XYZ"})
    expect_error("[[support]]\nregion = \"z-\"\nfix = \"" + fix + "\"\n", "each once");
  for (const std::string fix : {"x", "zy", "xyz"})
    EXPECT_EQ(scene_error(scene_text("[[support]]\nregion = \"z-\"\nfix = \"" + fix + "\"\n")), "")
        << fix;
}

TEST(SceneCheck, needs_a_moving_support_to_be_fixed_in_all_components) {
  const std::string path = "path = [ { time = 0, displacement = [0, 0, 0] } ]\n";
  expect_error("[[support]]\nregion = \"z-\"\nfix = \"xy\"\n" + path, "a moving support needs fix");
  EXPECT_EQ(scene_error(scene_text("[[support]]\nregion = \"z-\"\n" + path)), "");
}

TEST(SceneCheck, needs_ascending_times) {
  expect_error(
      "[[support]]\nregion = \"z-\"\npath = [ { time = 1, displacement = [0, 0, 0] }, { time = 1, "
      "displacement = [0, 0, 1] } ]\n",
      "must ascend");
  expect_error(
      instrument_text("probe",
                      "{ time = 2, position = [0, 0, 1] }, { time = 1, position = [0, 0, 1] }"),
      "must ascend");
}

TEST(SceneCheck, needs_a_direction_that_is_not_zero_and_a_forward_across_it) {
  const auto key = [](const std::string& more) {
    return instrument_text("probe", "{ time = 0, position = [0, 0, 1], " + more + " }");
  };
  expect_error(key("direction = [0, 0, 0]"), "must not be zero");
  expect_error(key("direction = [1, 0, 0]"),
               "forward must not be parallel");  // the default of forward
  expect_error(key("forward = [0, 0, 0]"), "forward must not be parallel");
  expect_error(key("direction = [1, 2, 3], forward = [-2, -4, -6]"),
               "forward must not be parallel");
  EXPECT_EQ(scene_error(scene_text(key("direction = [1, 0, 0], forward = [0, 1, 0]"))), "");
}

TEST(SceneCheck, needs_a_path_for_an_instrument) {
  expect_error(instrument_text("probe", ""), "at least one key");
}

TEST(SceneCheck, gives_instruments_the_name_of_their_kind_and_refuses_two_of_one_name) {
  const Scene scene = load_scene_text(scene_text(
      instrument_text("probe") + instrument_text("grasper") + instrument_text("scalpel")));
  EXPECT_EQ(scene.instruments[0].name, "probe");
  EXPECT_EQ(scene.instruments[1].name, "grasper");
  EXPECT_EQ(scene.instruments[2].name, "scalpel");
  expect_error(instrument_text("probe") + instrument_text("probe"),
               "two instruments are called \"probe\"");
  expect_error(instrument_text("probe") + "name = \"marker_a\"\n[[marker]]\nname = \"a\"\n" +
                   "position = [0, 0, 0]\n",
               "\"marker_a\" is what the metrics call a marker or a support");
}

TEST(SceneCheck, lets_only_graspers_and_scissors_act) {
  const std::string keys = "{ time = 0, position = [0, 0, 1], action = \"close\" }";
  expect_error(instrument_text("probe", keys), "only graspers and scissors open and close");
  EXPECT_EQ(scene_error(scene_text(instrument_text("grasper", keys))), "");
  EXPECT_EQ(scene_error(scene_text(instrument_text("scissors", keys))), "");
}

TEST(SceneCheck, needs_a_camera_that_looks_somewhere) {
  expect_error("[[camera]]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n", "eye and target must differ");
  expect_error("[[camera]]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n",
               "up must not point along the view");
  EXPECT_EQ(
      scene_error(scene_text("[[camera]]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\n")),
      "");
}

std::string output_text(const std::string& kind, const std::string& file,
                        const std::string& more = "") {
  return "[[output]]\nkind = \"" + kind + "\"\nfile = \"" + file + "\"\n" + more;
}

TEST(SceneCheck, keeps_outputs_inside_the_output_folder) {
  for (const std::string file :
       {"", "/tmp/m.csv", "../m.csv", "a/../../m.csv", "a/..", ".", "a/", "./"})
    expect_error(output_text("metrics", file), "must be a relative path inside the output folder");
  for (const std::string file : {"m.csv", "a/m.csv", "a b;c.csv", "..m.csv"})
    EXPECT_EQ(scene_error(scene_text(output_text("metrics", file))), "") << file;
}

TEST(SceneCheck, refuses_two_outputs_of_one_name_however_it_is_written) {
  expect_error(output_text("metrics", "a") + output_text("recording", "a"),
               "two outputs write \"a\"");
  expect_error(output_text("metrics", "b/a") + output_text("recording", "./b//a"),
               "two outputs write");
}

TEST(SceneCheck, refuses_outputs_that_would_overwrite_the_files_of_every_run) {
  for (const std::string file : {"summary.json", "scene.toml", "./summary.json", ".trocar-lock"})
    expect_error(output_text("metrics", file), "is written by every run");
}

TEST(SceneCheck, refuses_an_output_inside_a_file) {
  expect_error(output_text("metrics", "a/b") + output_text("metrics", "a"), "lies in \"a\"");
  expect_error(output_text("metrics", "summary.json/a"), "lies in \"summary.json\"");
  EXPECT_EQ(scene_error(scene_text(camera_text + output_text("frames", "a") +
                                   output_text("metrics", "a/b") + output_text("metrics", "ab"))),
            "");
}

TEST(SceneCheck, refuses_an_output_under_the_name_of_a_picture_of_a_frames_output) {
  const std::string frames = camera_text + output_text("frames", "a/f");
  expect_error(frames + output_text("metrics", "a/f/000002.png"), "has the name of a picture");
  expect_error(output_text("metrics", "./a//f/12.png") + frames, "has the name of a picture");
  EXPECT_EQ(scene_error(scene_text(frames + output_text("metrics", "a/f/2.csv") +
                                   output_text("contact-sheet", "a/f/all.png") +
                                   output_text("contact-sheet", "a/000002.png"))),
            "");
}

TEST(SceneCheck, refuses_two_cameras_of_one_name) {
  expect_error(camera_text + camera_text, "two cameras are called \"endoscope\"");
}

TEST(SceneCheck, needs_a_known_camera_for_pictures) {
  for (const std::string kind : {"video", "frames", "contact-sheet"}) {
    expect_error(output_text(kind, "a"), "a picture needs a [[camera]]");
    expect_error(camera_text + output_text(kind, "a", "camera = \"other\"\n"),
                 "there is no camera \"other\"");
    EXPECT_EQ(
        scene_error(scene_text(camera_text + output_text(kind, "a", "camera = \"endoscope\"\n"))),
        "");
  }
  EXPECT_EQ(scene_error(scene_text(output_text("metrics", "a"))), "");
}

TEST(SceneCheck, looks_at_overridden_values) {
  const TestFolder folder;
  const std::string file =
      write_text(folder.file("s.toml"), scene_text(output_text("metrics", "m.csv")));
  EXPECT_EQ(load_scene(file, {"time.duration=2 s"}).scene.time.duration, 2);
  EXPECT_TRUE(contains(error_of([&] { load_scene(file, {"time.duration=1 ms"}); }),
                       "shorter than one frame"));
  EXPECT_TRUE(contains(error_of([&] { load_scene(file, {"output[0].file='../m.csv'"}); }),
                       "inside the output folder"));
}

TEST(SceneCheck, says_which_line_is_wrong) {
  const TestFolder folder;
  const std::string file =
      write_text(folder.file("s.toml"), scene_text("[[support]]\nregion = \"z-\"\nfix = \"q\"\n"));
  EXPECT_TRUE(contains(error_of([&] { load_scene(file, {}); }), file + ":7:"));
}

TEST(SceneCheck, needs_a_region_with_low_below_high) {
  expect_error("[[region]]\nname = \"r\"\nlow = [0, 2, 0]\nhigh = [1, 1, 1]\n",
               "low is above high along y, so that the box holds nothing: exchange them");
  EXPECT_EQ(scene_error(scene_text("[[region]]\nname = \"r\"\nlow = [0, 1, 0]\nhigh = [1, 1, "
                                   "1]\n")),
            "");
}

TEST(SceneCheck, refuses_names_with_line_breaks) {
  expect_error(instrument_text("probe") + "name = \"a\\nb\"\n", "a name must not have line breaks");
  expect_error("[[marker]]\nname = \"a\\tb\"\nposition = [0, 0, 0]\n",
               "a name must not have line breaks");
}

TEST(SceneCheck, refuses_a_contact_sheet_that_is_not_called_a_png) {
  const auto sheet = [](const std::string& file) {
    return camera_text + "[[output]]\nkind = \"contact-sheet\"\nfile = \"" + file + "\"\n";
  };
  expect_error(sheet("a.jpg"), "a contact sheet is a PNG picture, and \"a.jpg\"");
  EXPECT_EQ(scene_error(scene_text(sheet("a.png"))), "");
}

// "line:column key" of each error of a scene with these lines after "[time]\nduration = 1\n".
std::vector<std::string> places(const std::string& lines) {
  std::istringstream text(scene_error("[time]\nduration = 1\n" + lines));
  std::vector<std::string> found;
  for (std::string line; std::getline(text, line);) {
    const std::size_t at = line.find("s.toml:");
    if (at == std::string::npos) continue;
    const std::size_t place = at + 7, key = line.find(": ", place);
    found.push_back(line.substr(place, key - place) + " " +
                    line.substr(key + 2, line.find(": ", key + 2) - key - 2));
  }
  return found;
}
using Places = std::vector<std::string>;

const std::string box_table = "[tissue.shape]\nkind = \"box\"\n";

TEST(SceneCheck, tells_all_errors_of_a_scene_in_the_order_of_its_lines) {
  EXPECT_EQ(
      places(R"([tissue.shape]
kind = "box"
high = [1, 1, -1]
[[region]]
name = "r"
low = [1, 0, 0]
high = [0, 1, 1]
[tissue.material]
c10 = 3
k1 = 4
[[support]]
region = "r"
fix = "xx"
[[load]]
region = "r"
[solver]
sleep = "1 mm"
[contact]
tissue = true
[[instrument]]
kind = "probe"
path = [{ time = 1, position = [0, 0, 1], action = "open" }, { time = 0, position = [0, 0, 1] }]
[[output]]
kind = "video"
file = "/a"
)"),
      (Places{"5:8 tissue.shape.high", "8:7 region[0].low", "11:7 tissue.material.c10",
              "12:6 tissue.material.k1", "15:7 support[0].fix", "16:1 load[0]",
              "21:10 contact.tissue", "24:52 instrument[0].path[0].action",
              "24:71 instrument[0].path[1].time", "26:8 output[0].kind", "27:8 output[0].file"}));
}

// Of the tables whose keys could all be read.
TEST(SceneCheck, tells_of_values_that_do_not_fit_beside_keys_that_can_not_be_read) {
  EXPECT_EQ(places(box_table +
                   "high = [1, 1, -1]\n[[support]]\nregion = 3\nfix = \"q\"\n[[support]]\nregion = "
                   "\"z-\"\nfix = \"q\"\n[[camra]]\n[[output]]\nkind = \"video\"\nfile = \"a\"\n"),
            (Places{"5:8 tissue.shape.high", "7:10 support[0].region", "11:7 support[1].fix",
                    "12:3 camra"}));
  EXPECT_EQ(places("[tisue.shape]\nkind = \"box\"\n"), (Places{"1:1 the required key \"tissue\" is "
                                                               "missing (table",
                                                               "3:2 tisue"}));
}

TEST(SceneCheck, tells_once_what_follows_from_one_error) {
  EXPECT_EQ(places(box_table + instrument_text("probe",
                                               "{ time = 5, position = [0, 0, 1] }, { time = 3, "
                                               "position = [0, 0, 1] }, { time = 2, position = [0, "
                                               "0, 1] }")),
            (Places{"7:55 instrument[0].path[1].time"}));
  EXPECT_EQ(places(box_table + output_text("video", "a") + output_text("frames", "b")),
            (Places{"6:8 output[0].kind"}));
  EXPECT_EQ(places(box_table + output_text("metrics", "../a") + output_text("metrics", "../a")),
            (Places{"7:8 output[0].file", "10:8 output[1].file"}));
  EXPECT_EQ(places(box_table + "[tissue.material]\nmodel = \"ogden\"\nc10 = 3\n"),
            (Places{"6:9 tissue.material.model", "7:7 tissue.material.c10"}));
  EXPECT_EQ(places(box_table + "[tissue.material]\ntissue = \"lever\"\nc10 = 3\n"),
            (Places{"6:10 tissue.material.tissue"}));
}

TEST(SceneCheck, says_whose_viscosity_bars_sleep_and_local_steps_and_how_to_leave_it_out) {
  const std::string scene = scene_text(
      "[tissue.material]\ntissue = \"liver\"\n"
      "[[tissue.region_material]]\nregion = \"x-\"\nmaterial = { tissue = \"fat\" }\n"
      "[[tissue.region_material]]\nregion = \"x+\"\n"
      "material = { prony = [{ share = 0.2, time = 1 }] }\n");
  const std::string body = "--set 'tissue.material.prony=[]'",
                    region = "--set 'tissue.region_material[1].material.prony=[]'";
  const std::string both =
      "the Prony branches of the body (tissue \"liver\") and of region \"x+\", "
      "by prony = [] there (" +
      body + " " + region + ")";
  const auto error = [&](const std::vector<std::string>& settings) {
    return error_of([&] { load_scene_text(scene, settings); });
  };
  const std::string sleep = "solver.sleep=0.001", local_steps = "solver.multirate=true";
  const std::string of_sleep = error({sleep}), of_steps = error({local_steps});
  EXPECT_TRUE(contains(of_sleep, "can't sleep: leave out sleep, or " + both)) << of_sleep;
  EXPECT_TRUE(contains(of_steps, "mass_scaling_step: leave out multirate, or " + both)) << of_steps;
  const std::string no_body = "tissue.material.prony=[]",
                    no_region = "tissue.region_material[1].material.prony=[]";
  const std::string one = "branches of region \"x+\", by prony = [] there (" + region + ")";
  EXPECT_TRUE(contains(error({sleep, no_body}), one)) << error({sleep, no_body});
  EXPECT_EQ(error({sleep, no_body, no_region}), "");
  EXPECT_EQ(error({local_steps, no_body, no_region}), "");
}

TEST(SceneCheck, points_at_the_key_that_is_wrong) {
  const auto expect_place = [](const std::string& lines, const std::string& place) {
    EXPECT_EQ(places(box_table + lines), Places{place}) << lines;
  };
  expect_place("[tissue.material]\nmodel = \"yeoh\"\n", "6:9 tissue.material.model");
  expect_place("[tissue.material]\nprony = [{ share = 2e-1, time = 1 }, { share = 1, time = 2 }]\n",
               "6:9 tissue.material.prony");
  expect_place("[tissue.material]\nmodel = \"mooney-rivlin\"\nc10 = -1\n",
               "7:7 tissue.material.c10");
  expect_place(
      "[[support]]\nregion = \"z-\"\nfix = \"x\"\npath = [{ time = 0, displacement = [0, 0, "
      "0] }]\n",
      "7:7 support[0].fix");
  expect_place("[[load]]\nregion = \"z-\"\npressure = 0\n", "7:12 load[0].pressure");
  expect_place("[[camera]]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n", "7:10 camera[0].target");
  expect_place("[[camera]]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 2]\n",
               "8:6 camera[0].up");
  expect_place("[tissue]\nmesh = \"m.msh\"\n", "6:8 tissue.mesh");
  expect_place(
      instrument_text("probe") + "name = \"a\"\n" + instrument_text("probe") + "name = \"a\"\n",
      "12:8 instrument[1].name");
}

TEST(SceneCheck, step_factor_is_the_one_given_or_the_body_s) {
  const Mesh plane = make_rectangle(1, 1, 2, 2),
             box = make_box(Vec3::Zero(), Vec3::Ones(), {1, 1, 1}, BoxElements::hex8);
  const auto factor = [](const std::string& keys, const Mesh& mesh) {
    return step_factor_of(load_scene_text(scene_text("[solver]\n" + keys)).solver, mesh);
  };
  const std::string stress = "triangle = \"plane-stress\"\n";
  EXPECT_EQ(factor("", plane), 0.85);
  EXPECT_EQ(factor(stress, plane), 0.7);
  EXPECT_EQ(factor(stress, box), 0.85);
  EXPECT_EQ(factor(stress + "step_factor = 0.8\n", plane), 0.8);
}

}  // namespace
}  // namespace trocar
