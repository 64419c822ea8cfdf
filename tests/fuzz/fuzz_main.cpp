// The entry points of libFuzzer for the target TROCAR_FUZZ_TARGET. `fuzz_gmsh --seeds FOLDER`
// writes the target's seeds; else the arguments are libFuzzer's.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>

#include "fuzz_targets.h"
#include "test_files.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace trocar {

namespace {

const FuzzTarget& this_target() {
  static const std::vector<FuzzTarget> targets = fuzz_targets();
  return *std::ranges::find(targets, TROCAR_FUZZ_TARGET, &FuzzTarget::name);
}

void write_seeds(const std::string& folder) {
  std::filesystem::create_directories(folder);
  for (const FuzzSeed& seed : this_target().seeds())
    write_text(folder + "/" + seed.name, seed.bytes);
}

std::string with_libfuzzers_change(const std::string& bytes, std::size_t most) {
  std::string changed = bytes;
  changed.resize(most);
  auto* data = reinterpret_cast<std::uint8_t*>(changed.data());
  changed.resize(LLVMFuzzerMutate(data, bytes.size(), most));
  return changed;
}

}  // namespace

}  // namespace trocar

extern "C" int LLVMFuzzerInitialize(int* n_arguments, char*** arguments) {
  if (*n_arguments != 3 || std::string_view((*arguments)[1]) != "--seeds") return 0;
  trocar::write_seeds((*arguments)[2]);
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  trocar::this_target().read({reinterpret_cast<const char*>(data), size});
  return 0;
}

// A fourth of all changes is one of counts; of files with checksums only a fourth leaves these
// alone.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  using namespace trocar;
  std::mt19937_64 random(seed);
  const bool is_of_count = random() % 4 == 0, is_outside = random() % 4 == 0;
  const std::uint64_t number = random();
  const ChangeBytes change = [&](const std::string& bytes) {
    return is_of_count
               ? with_hostile_count(bytes, number)
               : with_libfuzzers_change(bytes, std::max(bytes.size() + 64, std::size_t{64}));
  };
  const std::string file(reinterpret_cast<const char*>(data), size);
  const FuzzTarget& target = this_target();
  const std::string changed = target.change_inside == nullptr || is_outside
                                  ? change(file)
                                  : target.change_inside(file, change, random());
  const std::size_t n = std::min(changed.size(), most);
  std::memcpy(data, changed.data(), n);
  return n;
}
