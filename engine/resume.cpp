#include "engine/resume.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/on_root.h"
#include "base/whole_file.h"
#include "engine/checkpoint_file.h"

namespace trocar {

namespace {

Scene without_free_keys(Scene scene) {
  scene.time.duration = 1;
  scene.time.forget_deadlines();
  scene.checkpoint = {};
  scene.cameras.clear();
  scene.outputs.clear();
  return scene;
}

std::string time_text(const Checkpoint& checkpoint, const LoadedScene& loaded) {
  return with_decimals(loaded.scene.time.at(checkpoint.frame), 3) + " s";
}

void check_end(const Checkpoint& checkpoint, const LoadedScene& loaded) {
  const SceneTime& time = loaded.scene.time;
  if (checkpoint.frame > time.n_frames())
    loaded.where.fail("time.duration", "the checkpoint is at " + time_text(checkpoint, loaded) +
                                           ", behind the end of this scene");
}

}  // namespace

void require_same_scene(const std::string& before, const LoadedScene& now) {
  Scene old;
  SourceMap where;
  read_options_text(scene_options(), before, "the checkpoint's scene", {}, &old, where);
  const auto keys_of = [](const Scene& scene) {
    const Scene compared = without_free_keys(scene);
    return flat_options(scene_options(), &compared);
  };
  const std::vector<OptionText> earlier = keys_of(old), after = keys_of(now.scene);
  const auto fail = [&](const OptionText& at, const std::string& sentence) {
    now.where.fail(at.key, "the stopped run had " + sentence +
                               ": resume it with the same scene, or start anew without --resume");
  };
  const auto find = [](const std::vector<OptionText>& keys, const OptionText& wanted) {
    return std::ranges::find(keys, wanted.key, &OptionText::key);
  };
  for (const OptionText& was : earlier) {
    const auto is = find(after, was);
    if (is == after.end()) fail(was, was.value + ", and this scene has no such key");
    if (is->value != was.value) fail(was, was.value);
  }
  for (const OptionText& is : after)
    if (find(earlier, is) == earlier.end()) fail(is, "no such key");
}

Checkpoint load_checkpoint(const std::string& folder, const LoadedScene& loaded,
                           Communicator& communicator) {
  const std::string file = folder + "/" + checkpoint_name;
  Checkpoint checkpoint;
  const std::vector<std::byte> bytes = read_on_root(communicator, [&] {
    if (!std::filesystem::exists(file))
      throw InputError("\"" + folder + "\" holds no checkpoint (" + checkpoint_name +
                       ") to resume from; start the run without --resume");
    const std::string content = read_whole_file(file);
    const auto read = std::as_bytes(std::span(content));
    checkpoint = checkpoint_from_bytes(read, file);
    require_same_scene(checkpoint.scene, loaded);
    check_end(checkpoint, loaded);
    return std::vector<std::byte>(read.begin(), read.end());
  });
  if (!communicator.is_root()) checkpoint = checkpoint_from_bytes(bytes, file);
  log_info("resuming at " + time_text(checkpoint, loaded) + ", frame " +
           std::to_string(checkpoint.frame));
  return checkpoint;
}

}  // namespace trocar
