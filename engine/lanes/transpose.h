/// Transposes small matrices with shuffles of four floats, in the same way on every processor.
#pragma once

#include "base/device.h"

namespace hedon {
namespace {

#if defined(__CUDACC__)

/// CUDA devices have no such shuffles.
HEDON_INLINE void transpose(const float* from, int size, float* to) {
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) to[column * size + row] = from[row * size + column];
  }
}

#else

typedef float FourFloats __attribute__((vector_size(16), may_alias));

/// Writes the transpose of a (size, size) matrix; size is a multiple of 4, both are aligned to 16 bytes.
HEDON_INLINE void transpose(const float* from, int size, float* to) {
  for (int row = 0; row < size; row += 4) {
    for (int column = 0; column < size; column += 4) {
      const float* const at = from + row * size + column;
      const FourFloats a = *reinterpret_cast<const FourFloats*>(at);
      const FourFloats b = *reinterpret_cast<const FourFloats*>(at + size);
      const FourFloats c = *reinterpret_cast<const FourFloats*>(at + 2 * size);
      const FourFloats d = *reinterpret_cast<const FourFloats*>(at + 3 * size);
      const FourFloats ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
      const FourFloats ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
      const FourFloats cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
      const FourFloats cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
      float* const out = to + column * size + row;
      *reinterpret_cast<FourFloats*>(out) = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
      *reinterpret_cast<FourFloats*>(out + size) = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
      *reinterpret_cast<FourFloats*>(out + 2 * size) = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
      *reinterpret_cast<FourFloats*>(out + 3 * size) = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
    }
  }
}

#endif

}  // namespace
}  // namespace hedon
