/// Marks functions that run inside a step, so that the same source compiles for the CPU and for CUDA.
#pragma once

#include <cstdint>

#if defined(__CUDACC__)
#define HEDON_FN __host__ __device__ inline
#else
#define HEDON_FN inline
#endif

/// For functions that are called from units compiled for one instruction set. They are always inlined, since of several
/// copies, the linker could keep one that other processors cannot run.
#if defined(__CUDACC__)
#define HEDON_INLINE __host__ __device__ __forceinline__
#else
#define HEDON_INLINE __attribute__((always_inline)) inline
#endif

/// For a function that takes much time outside the kernels: GCC compiles it twice, with all functions that it calls,
/// for any processor and for AVX2, with the same bits, and the loader chooses. Clang's single version is as fast.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HEDON_CLONED __attribute__((flatten, target_clones("avx2", "default")))
#else
#define HEDON_CLONED
#endif

namespace hedon {

/// Index of the lowest bit that is set; at least one must be.
HEDON_INLINE int lowest_bit(uint64_t bits) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(bits)) - 1;
#else
  return __builtin_ctzll(bits);
#endif
}

/// Prefetches `count` floats that will be read soon.
HEDON_INLINE void ask_for(const float* first, int count) {
#if !defined(__CUDA_ARCH__)
  for (int i = 0; i < count; i += 16) __builtin_prefetch(first + i);
#endif
}

}  // namespace hedon
