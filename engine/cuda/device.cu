/// The library of a CUDA device: the kernels of `window.h`, run by CUDA's runtime.
#include <cuda_runtime.h>

#include <string>

#include "cuda/window.h"

namespace hedon {
namespace {

template <class Kernel>
__global__ void __launch_bounds__(BLOCK_THREADS) run_kernel(const Kernel kernel) {
  kernel(static_cast<int32_t>(blockIdx.x));
}

/// What went wrong, as a text that stays until the next call; "" for success.
const char* text_of(cudaError_t error) {
  static std::string text;
  if (error == cudaSuccess) return "";
  text = std::string("CUDA says '") + cudaGetErrorString(error) + "'";
  return text.c_str();
}

/// Starts a kernel after those before it. Only the first failure of several launches is of interest.
template <class Kernel>
cudaError_t start(const Kernel& kernel, int64_t floats) {
  const int bytes = static_cast<int>(floats * static_cast<int64_t>(sizeof(float)));
  const cudaError_t allowed =
      cudaFuncSetAttribute(run_kernel<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes);
  if (allowed != cudaSuccess) return allowed;
  run_kernel<<<static_cast<unsigned>(kernel.blocks()), BLOCK_THREADS, static_cast<size_t>(bytes)>>>(kernel);
  return cudaGetLastError();
}

const char* open_device() {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found == cudaErrorInsufficientDriver || found == cudaErrorNoDevice || (found == cudaSuccess && devices == 0))
    return "this machine has no CUDA device, or its driver is missing or too old";
  if (found != cudaSuccess) return text_of(found);
  int shared = 0;
  const cudaError_t asked = cudaDeviceGetAttribute(&shared, cudaDevAttrMaxSharedMemoryPerBlockOptin, 0);
  if (asked != cudaSuccess) return text_of(asked);
  if (shared < SHARED_FLOATS * static_cast<int>(sizeof(float)))
    return "its blocks have too little shared memory: it takes a device of compute capability 9.0 or newer";
  return "";
}

/// An update fills the shared memory of a multiprocessor, so one block runs on each.
int32_t learners_at_once() {
  int multiprocessors = 1;
  if (cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, 0) != cudaSuccess) return 1;
  return multiprocessors;
}

void* reserve(int64_t bytes) {
  void* block = nullptr;
  return cudaMalloc(&block, static_cast<size_t>(bytes)) == cudaSuccess ? block : nullptr;
}

void release(void* block) { static_cast<void>(cudaFree(block)); }

const char* copy_in(void* to, const void* from, int64_t bytes) {
  return text_of(cudaMemcpy(to, from, static_cast<size_t>(bytes), cudaMemcpyHostToDevice));
}

const char* copy_out(void* to, const void* from, int64_t bytes) {
  return text_of(cudaMemcpy(to, from, static_cast<size_t>(bytes), cudaMemcpyDeviceToHost));
}

const char* fill_kernel(Kernel* kernel) {
  const cudaError_t started = start(FillKernel{kernel}, FillKernel::FLOATS);
  return text_of(started != cudaSuccess ? started : cudaDeviceSynchronize());
}

const char* advance_all(const DeviceWorlds& worlds, int64_t step, int64_t steps) {
  cudaError_t first = cudaSuccess;
  advance_worlds(worlds, step, steps, [&](const auto& kernel, int64_t floats) {
    if (first == cudaSuccess) first = start(kernel, floats);
  });
  return text_of(first != cudaSuccess ? first : cudaDeviceSynchronize());
}

const DeviceProgram PROGRAM = {
    "cuda",  device_layout(), WIDEST_NETWORK, open_device, learners_at_once, reserve,
    release, copy_in,         copy_out,       fill_kernel, advance_all,
};

}  // namespace
}  // namespace hedon

extern "C" __attribute__((visibility("default"))) const hedon::DeviceProgram* hedon_device() { return &hedon::PROGRAM; }
