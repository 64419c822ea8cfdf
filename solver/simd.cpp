// Picks the kernels at run time.
#include "solver/simd.h"

#include <atomic>

#include "base/error.h"
#include "solver/step.h"

namespace trocar {

namespace scalar {
Kernels make_kernels();
}
namespace sse2 {
Kernels make_kernels();
}
namespace avx2 {
Kernels make_kernels();
}
namespace avx512 {
Kernels make_kernels();
}

const char* name_of(Simd simd) {
  constexpr const char* names[n_simd] = {"scalar", "sse2", "avx2", "avx512"};
  return names[static_cast<int>(simd)];
}

// x86-64-v3 and v4, as far as the compiler uses them here.
bool is_supported(Simd simd) {
  if (simd == Simd::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (simd == Simd::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd");
  return true;
}

// Each table is made when it is first asked for, by code of its own instruction set.
const Kernels& kernels_of(Simd simd) {
  switch (simd) {
    case Simd::sse2: {
      static const Kernels kernels = sse2::make_kernels();
      return kernels;
    }
    case Simd::avx2: {
      static const Kernels kernels = avx2::make_kernels();
      return kernels;
    }
    case Simd::avx512: {
      static const Kernels kernels = avx512::make_kernels();
      return kernels;
    }
    case Simd::scalar:
      break;
  }
  static const Kernels kernels = scalar::make_kernels();
  return kernels;
}

static Simd widest() {
  for (const Simd simd : {Simd::avx512, Simd::avx2})
    if (is_supported(simd)) return simd;
  return Simd::sse2;
}

// The machine's setting: the only thing here that outlives a call.
static std::atomic<Simd>& selection() {
  static std::atomic<Simd> simd{widest()};
  return simd;
}

Simd active_simd() {
  return selection().load(std::memory_order_relaxed);
}

const Kernels& active_kernels() {
  return kernels_of(active_simd());
}

const char* simd_name() {
  return name_of(active_simd());
}

void select_simd(const std::string& name) {
  if (name == "auto") {
    selection() = widest();
    return;
  }
  for (int i = 0; i < n_simd; ++i) {
    const Simd simd = static_cast<Simd>(i);
    if (name != name_of(simd)) continue;
    if (!is_supported(simd))
      throw InputError("this machine has no " + name + " instructions; use \"auto\", which picks " +
                       name_of(widest()));
    selection() = simd;
    return;
  }
  throw InputError("unknown instruction set \"" + name +
                   "\"; known are auto, scalar, sse2, avx2, avx512");
}

}  // namespace trocar
