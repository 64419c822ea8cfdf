#include "solver/hourglass_history.h"

namespace trocar {

namespace scalar {
HourglassKernels make_hourglass_kernels(Precision precision);
}
namespace sse2 {
HourglassKernels make_hourglass_kernels(Precision precision);
}
namespace avx2 {
HourglassKernels make_hourglass_kernels(Precision precision);
}
namespace avx512 {
HourglassKernels make_hourglass_kernels(Precision precision);
}

using MakeKernels = HourglassKernels(Precision precision);

// One for each precision, made when it is first asked for, by code of its own instruction set.
template <MakeKernels& make>
static const HourglassKernels& made_once(Precision precision) {
  if (precision == Precision::in_single) {
    static const HourglassKernels kernels = make(Precision::in_single);
    return kernels;
  }
  static const HourglassKernels kernels = make(Precision::in_double);
  return kernels;
}

const HourglassKernels& active_hourglass_kernels(Precision precision) {
  switch (active_simd()) {
    case Simd::sse2:
      return made_once<sse2::make_hourglass_kernels>(precision);
    case Simd::avx2:
      return made_once<avx2::make_hourglass_kernels>(precision);
    case Simd::avx512:
      return made_once<avx512::make_hourglass_kernels>(precision);
    case Simd::scalar:
      break;
  }
  return made_once<scalar::make_hourglass_kernels>(precision);
}

}  // namespace trocar
