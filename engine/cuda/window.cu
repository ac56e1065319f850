/// Whole windows of many worlds on a CUDA device, from the same sources as on the CPU: one block per world.
///
/// This unit is compiled as a test that the step path still compiles for a device; the engine does not load it yet. A
/// thread does the work of one member of a team, with lanes as loops. One thread does the update of a learner. A fast
/// version would put lanes on the threads of a warp, and use one block per learner.
#include "lanes/cuda.h"

#include "cuda/block.h"
#include "kernel/table.h"
#include "simulation/window.h"

namespace hedon {

/// Tiles of the matrix products: small, since each number of a tile is a register.
struct CudaShape {
  static constexpr int rows = 2;
  static constexpr int lanes = 1;
  static constexpr int forward_lanes = 2;  // even, for weights in pairs
  static constexpr int samples = 1;
  static constexpr int row_samples = 1;
  static constexpr int row_lanes = 1;
  static constexpr int chains = 2;
};

/// Fills a table with the device's own kernels, whose addresses the host does not know.
__global__ void make_kernel_table(Kernel* kernel) { *kernel = make_table<CudaShape>("cuda"); }

/// Advances each world by `steps` steps, learning at the ends of windows. Block b has world b and its part of
/// `scratch`: `stride` floats per thread. All pointers of the worlds are the device's.
__global__ void advance_worlds(World* worlds, int64_t steps, float* scratch, int64_t stride) {
  Block block;
  float* const own = scratch + static_cast<int64_t>(blockIdx.x) * blockDim.x * stride;
  const auto together = [](Block& members, int64_t count, auto&& step_once) {
    for (int64_t i = 0; i < count && step_once(members); ++i) continue;
    return count;
  };
  advance(block, worlds[blockIdx.x], steps, own, stride, together, [](Part) {});
}

}  // namespace hedon
