/// The hot kernels of one instruction set, in a table for each purpose; one set is chosen when a simulation is made.
///
/// The units that fill a table are compiled for their instruction set. So they must not define anything that the linker
/// could use in other code: everything in them is in an anonymous namespace, and they include no standard containers.
#pragma once

#include <cstdint>

#include "kernel/network_table.h"
#include "kernel/ray_table.h"

namespace hedon {

/// Kernels that measure the processor.
struct RateKernels {
  /// Multiply-adds in registers, to measure this processor's peak rate. Reads a factor (below 1) from `result` and
  /// writes there a number that depends on all of them. Returns the number of floating-point operations.
  int64_t (*multiply_adds)(int64_t rounds, float* result);

  /// Sum of `count` floats, a multiple of 64, aligned to 64 bytes: reads as fast as possible, to measure caches.
  float (*sum_floats)(const float* values, int64_t count);
};

struct Kernel {
  const char* name;
  NetworkKernels network;
  RayKernels rays;
  RateKernels rates;
};

/// The kernel of that name if this processor can run it, the best one for an empty name, null for an unknown one.
const Kernel* find_kernel(const char* name);

/// Names of the kernels that this processor can run, best first, null-terminated.
const char* const* kernel_names();

}  // namespace hedon
