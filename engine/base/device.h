/// Marks functions that run inside a step, so that the same source compiles for the CPU and for CUDA.
#pragma once

#include <cstdint>

#if defined(__CUDACC__)
#define HEDON_FN __host__ __device__ inline
#else
#define HEDON_FN inline
#endif

/// For what is called from units that are compiled for one instruction set: never emitted as a function of its own, of
/// which the linker might keep the copy that other processors cannot run.
#if defined(__CUDACC__)
#define HEDON_INLINE __host__ __device__ __forceinline__
#else
#define HEDON_INLINE __attribute__((always_inline)) inline
#endif

namespace hedon {

/// Index of the lowest bit that is set, of at least one.
HEDON_INLINE int lowest_bit(uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(bits)) - 1;
#else
  return __builtin_ctzll(bits);
#endif
}

}  // namespace hedon
