/// The identity of a thread within its block, and its communication with others: CUDA's or the emulator's
/// (`emulator.h`).
///
/// A *tile* is 16 neighboring threads: each of them holds one of 16 lanes (`lanes.h`). All threads of a tile reach
/// its barriers, ballots and reads together, and all threads of a block reach the block's barriers together.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

inline constexpr int TILE = 16;

#if defined(__CUDA_ARCH__)

HEDON_INLINE int thread_rank() { return static_cast<int>(threadIdx.x); }
HEDON_INLINE int thread_count() { return static_cast<int>(blockDim.x); }
HEDON_INLINE void block_barrier() { __syncthreads(); }

/// The threads of this one's tile, as bits of its warp.
HEDON_INLINE uint32_t tile_mask() { return 0xFFFFu << (threadIdx.x & 16u); }
HEDON_INLINE void tile_barrier() { __syncwarp(tile_mask()); }

/// A mask with one bit per thread of the tile, set if its `holds` is true.
HEDON_INLINE uint32_t tile_ballot(bool holds) {
  return __ballot_sync(tile_mask(), holds) >> (threadIdx.x & 16u) & 0xFFFFu;
}

/// The value of another thread of the tile.
HEDON_INLINE float tile_read(float value, int lane) { return __shfl_sync(tile_mask(), value, lane, TILE); }

/// Sets bits of a word in which other threads may set bits at the same time.
HEDON_INLINE void thread_set_bits(uint64_t& word, uint64_t bits) {
  atomicOr(reinterpret_cast<unsigned long long*>(&word), bits);
}

/// Puts a value in a place where other threads may put theirs at the same time; returns what was there.
HEDON_INLINE int32_t thread_exchange(int32_t& place, int32_t value) { return atomicExch(&place, value); }

/// The block's shared memory, aligned to 16 bytes; its size is given at the launch. It is not initialized.
HEDON_INLINE float* shared_memory() {
  extern __shared__ float4 memory[];
  return reinterpret_cast<float*>(memory);
}

/// Begins to load global memory into L2, without waiting for it. Address and size are multiples of 16 bytes.
HEDON_INLINE void fetch_ahead(const float* from, int32_t bytes) {
  asm volatile("cp.async.bulk.prefetch.L2.global [%0], %1;" ::"l"(from), "r"(bytes));
}

#elif defined(__CUDACC__)

// nvcc compiles every function for the host too, where kernels never run.
HEDON_INLINE int thread_rank() { return 0; }
HEDON_INLINE int thread_count() { return 1; }
HEDON_INLINE void block_barrier() {}
HEDON_INLINE void tile_barrier() {}
HEDON_INLINE uint32_t tile_ballot(bool holds) { return holds ? 1u : 0u; }
HEDON_INLINE float tile_read(float value, int) { return value; }
HEDON_INLINE void thread_set_bits(uint64_t& word, uint64_t bits) { word |= bits; }
HEDON_INLINE int32_t thread_exchange(int32_t& place, int32_t value) {
  const int32_t before = place;
  place = value;
  return before;
}
HEDON_INLINE float* shared_memory() { return nullptr; }
HEDON_INLINE void fetch_ahead(const float*, int32_t) {}

#else

int thread_rank();
int thread_count();
void block_barrier();
void tile_barrier();
uint32_t tile_ballot(bool holds);
float tile_read(float value, int lane);
HEDON_INLINE void thread_set_bits(uint64_t& word, uint64_t bits) { __atomic_fetch_or(&word, bits, __ATOMIC_RELAXED); }
HEDON_INLINE int32_t thread_exchange(int32_t& place, int32_t value) {
  return __atomic_exchange_n(&place, value, __ATOMIC_RELAXED);
}
float* shared_memory();
HEDON_INLINE void fetch_ahead(const float*, int32_t) {}

#endif

HEDON_INLINE int thread_lane() { return thread_rank() % TILE; }

/// The count, below 2^24, of another thread of the tile.
HEDON_INLINE int32_t tile_read_count(int32_t count, int lane) {
  return static_cast<int32_t>(tile_read(static_cast<float>(count), lane));
}

/// The number of set bits.
HEDON_INLINE int count_bits(uint32_t bits) {
#if defined(__CUDA_ARCH__)
  return __popc(bits);
#else
  return __builtin_popcount(bits);
#endif
}

}  // namespace hedon
