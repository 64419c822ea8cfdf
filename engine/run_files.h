// What every run writes into its folder beside the scene's outputs.
#pragma once

#include <array>

namespace trocar {

inline constexpr const char* summary_name = "summary.json";
inline constexpr const char* scene_name = "scene.toml";  // the effective scene
inline constexpr const char* checkpoint_name = "checkpoint.bin";
inline constexpr const char* lock_name = ".trocar-lock";
inline constexpr std::array run_files = {summary_name, scene_name, checkpoint_name, lock_name};

}  // namespace trocar
