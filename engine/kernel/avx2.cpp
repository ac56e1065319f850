/// The kernels for x86 processors with AVX2 and FMA (2013 and later).
#if defined(__x86_64__)
#include "lanes/avx2.h"

#include "kernel/table.h"

namespace hedon {

/// Tiles of the matrix products, chosen to fill this instruction set's 16 registers of 8 floats.
struct Avx2Shape {
  static constexpr int rows = 6;           ///< rows of a tile
  static constexpr int lanes = 1;          ///< vectors of 16 columns in a tile
  static constexpr int forward_lanes = 4;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 1;        ///< samples that go forward through the first layer together
  static constexpr int row_samples = 2;    ///< samples that go backward through it together
  static constexpr int row_lanes = 2;      ///< vectors of 16 columns there
  static constexpr int chains = 6;         ///< for the measurement of the processor's peak rate
};

extern const Kernel AVX2_KERNEL;
const Kernel AVX2_KERNEL = make_table<Avx2Shape>("avx2");

}  // namespace hedon

#endif
