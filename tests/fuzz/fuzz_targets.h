// Readers of bytes that nobody vouches for, as libFuzzer (fuzz_main.cpp) and the tests
// (replay_test.cpp) call them. A target is a line in fuzz_targets(), and its name in
// CMakeLists.txt and scripts/fuzz.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace trocar {

// Anything is changed into anything.
using ChangeBytes = std::function<std::string(const std::string&)>;

struct FuzzSeed {
  std::string name, bytes;
};

struct FuzzTarget {
  std::string name;
  // Reads as the program does and looks at what came of it; false if it was refused with an
  // InputError. Any other exception, failed CHECK or report of a sanitizer is a fault.
  bool (*read)(std::string_view bytes);
  // Small files that are read.
  std::vector<FuzzSeed> (*seeds)();
  // Of a file with checksums: one of the parts that they cover, chosen by `random`, is changed and
  // the checksums are made right again. Null if there are none.
  std::string (*change_inside)(const std::string& file, const ChangeBytes& change,
                               std::uint64_t random) = nullptr;
};

std::vector<FuzzTarget> fuzz_targets();

// A number of the bytes, a decimal one or four or eight bytes in either order, becomes a count that
// no honest file has: 0, -1, 2^31, 2^61, …
std::string with_hostile_count(std::string bytes, std::uint64_t random);

// Calls read() and tells whether it threw no InputError.
bool is_taken(const std::function<void()>& read);
// Writes the bytes to a file of this name in a folder in memory, and returns its path; what is
// there is removed before.
std::string hostile_file(const std::string& name, std::string_view bytes);

bool read_scene_bytes(std::string_view bytes);
bool read_override_lines(std::string_view bytes);
bool read_gmsh_bytes(std::string_view bytes);
bool read_vtk_bytes(std::string_view bytes);
bool read_vtu_bytes(std::string_view bytes);
bool read_stl_bytes(std::string_view bytes);
bool read_obj_bytes(std::string_view bytes);
bool read_recording_bytes(std::string_view bytes);
bool read_checkpoint_bytes(std::string_view bytes);

std::vector<FuzzSeed> scene_seeds();
std::vector<FuzzSeed> override_seeds();
std::vector<FuzzSeed> gmsh_seeds();
std::vector<FuzzSeed> vtk_seeds();
std::vector<FuzzSeed> vtu_seeds();
std::vector<FuzzSeed> stl_seeds();
std::vector<FuzzSeed> obj_seeds();
std::vector<FuzzSeed> recording_seeds();
std::vector<FuzzSeed> checkpoint_seeds();

std::string change_recording(const std::string& file, const ChangeBytes& change,
                             std::uint64_t random);
std::string change_checkpoint(const std::string& file, const ChangeBytes& change,
                              std::uint64_t random);

}  // namespace trocar
