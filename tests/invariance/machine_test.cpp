// The same bits whatever the C library computes its functions with and whatever lies in memory that
// a program gets; and libraries that a scene has no use for are not opened.
#include <gtest/gtest.h>

#include "engine_resume.h"
#include "program.h"
#include "small_scenes.h"

namespace trocar {
namespace {

// Words of `env`; the run is in folder/out.
Finished run_with(const std::vector<std::string>& settings, const std::string& scene,
                  const std::string& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"env"};
  words.insert(words.end(), settings.begin(), settings.end());
  const std::string file = write_text(folder + "/scene.toml", scene);
  words.insert(words.end(), {TROCAR_PROGRAM, "run", file, "-q", "-o", folder + "/out"});
  words.insert(words.end(), more.begin(), more.end());
  const Finished run = run_words(words, folder, 60);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run;
}

std::string result_with(const std::string& setting, const std::string& scene) {
  const std::string folder = test_folder("machine");
  run_with({setting}, scene, folder, {"--threads", "1"});
  const nlohmann::json summary = read_summary(folder + "/out");
  if (!summary.is_object()) return "no summary";
  return summary.value("simd", "") + " " + summary.value("state_digest", "") + "\n" +
         metrics_without_times(folder + "/out/m.csv");
}

// glibc's sin, exp, pow and others have other bits without fused multiply-add.
TEST(Machine, gives_the_same_bits_without_fma_in_libm_and_with_other_bytes_in_fresh_memory) {
  for (const std::string& scene :
       {resume_block_text, resume_plane_text, small_scene("hex8 from equilibrium, cut, resumed"),
        small_scene("hex8 viscoelastic from equilibrium, pressed")}) {
    const std::string expected = result_with("LC_ALL=C", scene + metrics_table);
    EXPECT_NE(expected.find('\n'), std::string::npos) << expected;
    for (const char* setting :
         {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2", "MALLOC_PERTURB_=165"})
      EXPECT_EQ(result_with(setting, scene + metrics_table), expected) << setting;
  }
}

// What the dynamic linker tells of libraries that a run opens.
std::string libraries_of(const std::string& scene) {
  const std::string folder = test_folder("libraries"), place = folder + "/opened";
  std::filesystem::create_directory(place);
  run_with({"LD_DEBUG=files", "LD_DEBUG_OUTPUT=" + place + "/of"}, scene, folder,
           {"--set", "time.duration='0.1 s'"});
  std::string told;
  for (const auto& file : std::filesystem::directory_iterator(place))
    told += read_text(file.path().string());
  return told;
}

TEST(Machine, opens_no_renderer_for_a_scene_without_pictures) {
  const std::string camera = "[[camera]]\neye = [0, -1, 0]\ntarget = [0, 0, 0]\n",
                    picture = "[[output]]\nkind = \"frames\"\nfile = \"png\"\nsize = [16, 16]\n";
  const std::string scene = resume_block_text + metrics_table;
  for (const std::string& text : {scene, scene + camera}) {
    const std::string opened = libraries_of(text);
    EXPECT_NE(opened.find("libsqlite3"), std::string::npos);
    EXPECT_EQ(opened.find("OSMesa"), std::string::npos);
  }
  EXPECT_NE(libraries_of(scene + camera + picture).find("OSMesa"), std::string::npos);
}

}  // namespace
}  // namespace trocar
