#include "engine/resume.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/log.h"
#include "base/number_text.h"
#include "base/on_root.h"
#include "base/whole_file.h"
#include "engine/checkpoint_file.h"

namespace trocar {

namespace {

struct KeyValue {
  std::string key, value;  // "instrument[1].path[0].time"
};

// "instrument.path" as instrument[1].path[0], by how often each list was begun so far.
std::string numbered(const std::string& table, const std::map<std::string, int>& n_begun) {
  std::string path, plain;
  std::istringstream words(table);
  for (std::string word; std::getline(words, word, '.');) {
    plain += (plain.empty() ? "" : ".") + word;
    path += (path.empty() ? "" : ".") + word;
    const auto found = n_begun.find(plain);
    if (found != n_begun.end()) path += "[" + std::to_string(found->second) + "]";
  }
  return path;
}

// The lines of an effective scene with the whole path of each key.
std::vector<KeyValue> keys_of(const Scene& scene) {
  std::vector<KeyValue> keys;
  std::map<std::string, int> n_begun;  // index of the present item of each list
  std::string table;
  std::istringstream lines(echo_options(scene_options(), &scene));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[")) {
      table = line.substr(2, line.size() - 4);
      std::erase_if(n_begun, [&](const auto& list) { return list.first.starts_with(table + "."); });
      n_begun.try_emplace(table, -1).first->second += 1;
    } else if (line.starts_with("[")) {
      table = line.substr(1, line.size() - 2);
    } else if (const std::size_t at = line.find(" = "); at != std::string::npos) {
      const std::string path = table.empty() ? "" : numbered(table, n_begun) + ".";
      keys.push_back({.key = path + line.substr(0, at), .value = line.substr(at + 3)});
    }
  }
  return keys;
}

Scene without_free_keys(Scene scene) {
  scene.time.duration = 1;
  scene.time.pace = Pace::fast;
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
  const std::vector<KeyValue> earlier = keys_of(without_free_keys(old)),
                              after = keys_of(without_free_keys(now.scene));
  const auto fail = [&](const KeyValue& at, const std::string& sentence) {
    now.where.fail(at.key, "the stopped run had " + sentence +
                               ": resume it with the same scene, or start anew without --resume");
  };
  const auto find = [](const std::vector<KeyValue>& keys, const KeyValue& wanted) {
    return std::ranges::find(keys, wanted.key, &KeyValue::key);
  };
  for (const KeyValue& was : earlier) {
    const auto is = find(after, was);
    if (is == after.end() && was.value != "[]")
      fail(was, was.value + ", and this scene has no such key");
    if (is != after.end() && is->value != was.value) fail(was, was.value);
  }
  for (const KeyValue& is : after)
    if (find(earlier, is) == earlier.end() && is.value != "[]") fail(is, "no such key");
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
