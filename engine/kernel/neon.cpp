/// The kernels for 64-bit ARM processors, each of which has NEON.
#if defined(__aarch64__)
#include "lanes/neon.h"

#include "kernel/table.h"

namespace hedon {

/// Tiles of the matrix products, which fit this instruction set's 32 registers of 4 floats: 16 sums, 4 factors from
/// each side. They were chosen by this count, not by measurement, for lack of such a processor.
struct NeonShape {
  static constexpr int rows = 4;           ///< rows of a tile
  static constexpr int lanes = 1;          ///< vectors of 16 columns in a tile
  static constexpr int forward_lanes = 4;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 1;        ///< samples that go forward through the first layer together
  static constexpr int row_samples = 2;    ///< samples that go backward through it together
  static constexpr int row_lanes = 2;      ///< vectors of 16 columns there
  static constexpr int chains = 6;         ///< for the measurement of the processor's peak rate
};

extern const Kernel NEON_KERNEL;
const Kernel NEON_KERNEL = make_table<NeonShape>("neon");

}  // namespace hedon

#endif
