/// Marks functions that run inside a step, so that the same source compiles for the CPU and for CUDA.
#pragma once

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
