/// The kernels for x86 processors with AVX-512 (F, DQ, BW, VL).
#if defined(__x86_64__)
#include "lanes/avx512.h"

#include "kernel/table.h"

namespace hedon {

/// How the products are cut up to fill this instruction set's 32 registers of 16 floats.
struct Avx512Shape {
  static constexpr int rows = 4;           ///< of a product's tile
  static constexpr int lanes = 4;          ///< of 16 columns in a tile
  static constexpr int forward_lanes = 4;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 4;        ///< that go through the first layer together
  static constexpr int row_samples = 4;    ///< that go back through it together
  static constexpr int row_lanes = 4;      ///< of 16 columns in that
  static constexpr int chains = 12;        ///< for the measure of the processor's ceiling
};

extern const Kernel AVX512_KERNEL;
const Kernel AVX512_KERNEL = make_table<Avx512Shape>("avx512");

}  // namespace hedon

#endif
