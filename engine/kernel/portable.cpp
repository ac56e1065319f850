/// The kernels for any processor.
#include "lanes/portable.h"

#include "kernel/table.h"

namespace hedon {

/// Tiles of the matrix products, chosen to fill 16 registers of 4 floats, or more.
struct PortableShape {
  static constexpr int rows = 2;           ///< rows of a tile
  static constexpr int lanes = 1;          ///< vectors of 16 columns in a tile
  static constexpr int forward_lanes = 2;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 1;        ///< samples that go forward through the first layer together
  static constexpr int row_samples = 2;    ///< samples that go backward through it together
  static constexpr int row_lanes = 1;      ///< vectors of 16 columns there
  static constexpr int chains = 2;         ///< for the measurement of the processor's peak rate
};

extern const Kernel PORTABLE_KERNEL;
const Kernel PORTABLE_KERNEL = make_table<PortableShape>("portable");

}  // namespace hedon
