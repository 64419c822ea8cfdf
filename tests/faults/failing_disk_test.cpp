// Disks that fail and kills while files are written, through the front door: exit code, sentence,
// what is kept. runs_on_failing_files.cpp does this to each of a run's calls, without the program.
#include <gtest/gtest.h>

#include <cstdlib>

#include "failing_scene.h"
#include "program.h"

namespace trocar {
namespace {

// Words that run a program with the library before it. prefix: of the names of files that fail.
std::vector<std::string> with_failing_files(const std::string& fault, const std::string& prefix) {
  // An address sanitizer in the program would refuse to come second.
  const char* const asan = std::getenv("ASAN_OPTIONS");
  return {"env", std::string("LD_PRELOAD=") + TROCAR_FAILING_FILES, "TROCAR_FAULT=" + fault,
          "TROCAR_FAULT_FOLDER=" + prefix,
          std::string("ASAN_OPTIONS=") + (asan ? asan : "") + ":verify_asan_link_order=0"};
}

struct DiskRun {
  std::string folder, out = folder + "/out";

  explicit DiskRun(const std::string& text) : folder(test_folder("disk")) {
    write_text(folder + "/scene.toml", text);
  }
  std::vector<std::string> arguments() const {
    return {"run", folder + "/scene.toml", "-q", "-o", out, "--threads", "1"};
  }
  // What the run needs to fail so; file: within the output folder.
  std::vector<std::string> words(const std::string& fault, const std::string& file) const {
    std::vector<std::string> all = with_failing_files(fault, out + "/" + file);
    all.push_back(TROCAR_PROGRAM);
    for (const std::string& word : arguments()) all.push_back(word);
    return all;
  }
  Finished with(const std::string& fault, const std::string& file) const {
    return run_words(words(fault, file), folder, 60);
  }
  // From the checkpoint or, if there is none, anew.
  void expect_to_go_on(const std::string& digest) const {
    std::vector<std::string> words = arguments();
    if (std::filesystem::exists(out + "/checkpoint.bin")) words.push_back("--resume");
    const Finished run = run_trocar(words, folder, 60);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(digest_in(out), digest);
  }
  std::size_t n_frames_listed() const {
    const Finished list = run_trocar({"replay", out + "/r.trocar", "--list"}, folder, 60);
    EXPECT_EQ(list.exit_code, 0) << list.err;
    return std::size_t(std::count(list.out.begin(), list.out.end(), '\n'));
  }
};

std::string undisturbed_digest(const std::string& text) {
  const DiskRun disk(text);
  const Finished run = run_trocar(disk.arguments(), disk.folder, 60);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return digest_in(disk.out);
}

TEST(FailingDisk, ends_a_run_with_4_and_one_sentence_that_names_the_file) {
  const std::string digest = undisturbed_digest(failing_scene);
  for (const auto& [file, fault] : {std::pair<std::string, std::string>{"r.trocar", "full@44"},
                                    {"checkpoint.bin", "eio@12"},
                                    {"m.csv", "full@4"},
                                    {"summary.json", "full@2"}}) {
    SCOPED_TRACE(file + " " + fault);
    const DiskRun disk(failing_scene);
    const Finished run = disk.with(fault, file);
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_FALSE(Said(run.err).failed.empty());
    EXPECT_NE(run.err.find("[error] " + disk.out + "/" + file + ": can't be written"),
              std::string::npos)
        << run.err;
    if (file == "r.trocar") {
      EXPECT_EQ(disk.n_frames_listed(), n_metric_rows(disk.out));
      EXPECT_GT(n_metric_rows(disk.out), 0U);
    }
    disk.expect_to_go_on(digest);
  }
}

TEST(FailingDisk, of_rank_0_ends_all_ranks_with_one_sentence) {
  const DiskRun disk(failing_scene);
  const std::vector<std::string> words = disk.words("full@44", "r.trocar");
  const Finished run =
      run_words(mpirun_words(2, words[0], {words.begin() + 1, words.end()}), disk.folder, 60);
  EXPECT_EQ(run.exit_code, 4);
  const std::string told = "[error] " + disk.out + "/r.trocar: can't be written";
  const std::size_t at = run.err.find(told);
  EXPECT_NE(at, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("[error]", at + 1), std::string::npos) << run.err;
  EXPECT_EQ(disk.n_frames_listed(), n_metric_rows(disk.out));
}

// `timeout` ends as its child: by the signal, or with 128 + it.
TEST(FailingDisk, that_goes_away_with_the_program_keeps_all_committed_frames) {
  const std::string digest = undisturbed_digest(failing_scene);
  for (const auto& [file, fault] :
       {std::pair{"r.trocar", "half@50"}, {"checkpoint.bin", "half@16"}}) {
    SCOPED_TRACE(std::string(file) + " " + fault);
    const DiskRun disk(failing_scene);
    const Finished run = disk.with(fault, file);
    EXPECT_TRUE(run.exit_code == 137 || run.exit_code == -1) << run.exit_code << run.err;
    EXPECT_EQ(Said(run.err).failed.size(), 1U);
    EXPECT_GE(disk.n_frames_listed(), std::max<std::size_t>(1, n_metric_rows(disk.out)));
    disk.expect_to_go_on(digest);
  }
}

const std::string filmed_scene = failing_scene + R"([[camera]]
eye = [0, "-60 mm", "40 mm"]
target = ["10 mm", "10 mm", "5 mm"]
[[output]]
kind = "frames"
file = "png"
size = [16, 16]
)";

std::string picture(int frame) {
  return "png/00000" + std::to_string(frame) + ".png";
}

void expect_all_pictures(const DiskRun& disk) {
  for (int frame = 1; frame <= n_failing_frames; ++frame)
    EXPECT_FALSE(read_text(disk.out + "/" + picture(frame)).empty()) << picture(frame);
}

TEST(FailingDisk, names_the_picture_and_leaves_no_half_of_it) {
  for (const char* fault : {"full@3", "eio@1"}) {
    SCOPED_TRACE(fault);
    const DiskRun disk(filmed_scene);
    const Finished run = disk.with(fault, picture(2));
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_TRUE(Said(run.err).names_failed()) << run.err;
    EXPECT_FALSE(std::filesystem::exists(disk.out + "/" + picture(2)));
    EXPECT_FALSE(std::filesystem::exists(disk.out + "/" + picture(2) + ".part"));
  }
}

// They are drawn beside the frames: a checkpoint must not be ahead of them.
TEST(FailingDisk, loses_no_picture_of_a_run_that_is_resumed) {
  const std::string digest = undisturbed_digest(failing_scene);
  for (const char* fault : {"kill@3", "eio@1"}) {
    SCOPED_TRACE(fault);
    const DiskRun disk(filmed_scene);
    disk.with(fault, picture(2));
    disk.expect_to_go_on(digest);
    expect_all_pictures(disk);
  }
}

}  // namespace
}  // namespace trocar
