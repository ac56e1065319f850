/// The kernels for any processor.
#include "lanes/portable.h"

#include "kernel/table.h"

namespace hedon {

/// How the products are cut up to fill this instruction set's 16 registers of 4 floats, or more.
struct PortableShape {
  static constexpr int rows = 2;           ///< of a product's tile
  static constexpr int lanes = 1;          ///< of 16 columns in a tile
  static constexpr int forward_lanes = 2;  ///< the same for a single row; even, for weights in pairs
  static constexpr int samples = 1;        ///< that go through the first layer together
  static constexpr int row_samples = 2;    ///< that go back through it together
  static constexpr int row_lanes = 1;      ///< of 16 columns in that
  static constexpr int chains = 2;         ///< for the measure of the processor's ceiling
};

extern const Kernel PORTABLE_KERNEL;
const Kernel PORTABLE_KERNEL = make_table<PortableShape>("portable");

}  // namespace hedon
