/// Runs kernels of CUDA on a processor, with every thread of a block: for tests without a device.
///
/// The threads of a block are fibers, which run in turn, or threads of the system, so that the thread sanitizer sees
/// them. Shared memory is fresh for each block and full of NaN. A barrier that some threads do not reach ends the
/// program with a message if they are fibers.
#pragma once

#include <cstdint>
#include <functional>

namespace hedon {

/// The numbers, from 0, of a barrier of each block and of one of each tile at which no thread waits; none if negative.
/// For tests that such an error is detected.
inline int64_t lost_barrier = -1, lost_tile_barrier = -1;

/// Whether an address is in the shared memory of the block that is running.
bool is_shared(const void* place);

/// Runs blocks 0 … blocks - 1 of `threads` threads each, one block after another, as kernel(block).
/// threads   a multiple of 16
/// floats    of shared memory per block
void launch(int32_t blocks, int32_t threads, int64_t floats, const std::function<void(int32_t)>& kernel);

}  // namespace hedon
