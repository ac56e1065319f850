/// The kernels for x86 processors with AVX-512 (F, DQ, BW, VL).
#if defined(__x86_64__)
#include "lanes/avx512.h"

#include "kernel/table.h"

namespace hedon {

/// Tiles of the matrix products, chosen to fill this instruction set's 32 registers of 16 floats.
struct Avx512Shape {
  static constexpr int rows = 4;           ///< rows of a tile
  static constexpr int lanes = 4;          ///< vectors of 16 columns in a tile
  static constexpr int forward_lanes = 4;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 4;        ///< samples that go forward through the first layer together
  static constexpr int row_samples = 4;    ///< samples that go backward through it together
  static constexpr int row_lanes = 4;      ///< vectors of 16 columns there
  static constexpr int chains = 12;        ///< for the measurement of the processor's peak rate
};

extern const Kernel AVX512_KERNEL;
const Kernel AVX512_KERNEL = make_table<Avx512Shape>("avx512");

}  // namespace hedon

#endif
