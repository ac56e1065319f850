/// Marks functions that run inside a step, so that the same source compiles for the CPU and for CUDA.
#pragma once

#if defined(__CUDACC__)
#define HEDON_FN __host__ __device__ inline
#else
#define HEDON_FN inline
#endif
