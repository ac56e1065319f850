/// The library of a CUDA device: the kernels of `window.h`, run by CUDA's runtime.
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "cuda/window.h"

namespace hedon {
namespace {

constexpr int32_t MAX_DEVICES = 64;

template <class Kernel>
__global__ void __launch_bounds__(BLOCK_THREADS) run_kernel(const Kernel kernel) {
  kernel(static_cast<int32_t>(blockIdx.x));
}

/// The error, as a text that is valid until the thread's next call; "" for success. Clears an error that the device can
/// recover from; otherwise the next launch would report it.
const char* text_of(cudaError_t error) {
  static thread_local std::string text;
  if (error == cudaSuccess) return "";
  static_cast<void>(cudaGetLastError());
  text = std::string("CUDA says '") + cudaGetErrorString(error) + "'";
  return text.c_str();
}

/// Two events around a kernel.
struct Lap {
  DevicePart part;
  cudaEvent_t begin = nullptr, end = nullptr;
};

thread_local int32_t used = 0;
std::vector<Lap> laps_of[MAX_DEVICES];

/// Starts a kernel after the previous ones. Only the first failure of several launches matters.
template <class Kernel>
cudaError_t start(const Kernel& kernel, int64_t floats) {
  const int bytes = static_cast<int>(floats * static_cast<int64_t>(sizeof(float)));
  const cudaError_t allowed =
      cudaFuncSetAttribute(run_kernel<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes);
  if (allowed != cudaSuccess) return allowed;
  run_kernel<<<static_cast<unsigned>(kernel.blocks()), BLOCK_THREADS, static_cast<size_t>(bytes)>>>(kernel);
  return cudaGetLastError();
}

/// The same, with events recorded before and after it.
template <class Kernel>
cudaError_t start_timed(const Kernel& kernel, int64_t floats) {
  Lap lap{Kernel::PART};
  cudaError_t first = cudaEventCreate(&lap.begin);
  if (first == cudaSuccess) first = cudaEventCreate(&lap.end);
  if (first == cudaSuccess) first = cudaEventRecord(lap.begin);
  if (first == cudaSuccess) first = start(kernel, floats);
  if (first == cudaSuccess) first = cudaEventRecord(lap.end);
  laps_of[used].push_back(lap);
  return first;
}

int32_t count_devices() {
  int devices = 0;
  return cudaGetDeviceCount(&devices) == cudaSuccess ? std::min(devices, MAX_DEVICES) : 0;
}

const char* open_devices() {
  int devices = 0;
  const cudaError_t found = cudaGetDeviceCount(&devices);
  if (found != cudaSuccess) static_cast<void>(cudaGetLastError());
  if (found == cudaErrorInsufficientDriver || found == cudaErrorNoDevice || (found == cudaSuccess && devices == 0))
    return "this machine has no CUDA device, or its driver is missing or too old";
  if (found != cudaSuccess) return text_of(found);
  for (int32_t device = 0; device < count_devices(); ++device) {
    int shared = 0;
    const cudaError_t asked = cudaDeviceGetAttribute(&shared, cudaDevAttrMaxSharedMemoryPerBlockOptin, device);
    if (asked != cudaSuccess) return text_of(asked);
    if (shared < SHARED_FLOATS * static_cast<int>(sizeof(float)))
      return "its blocks have too little shared memory: it takes a device of compute capability 9.0 or 10.0 "
             "(CUDA_VISIBLE_DEVICES selects the devices)";
  }
  return "";
}

void use_device(int32_t device) {
  used = device;
  static_cast<void>(cudaSetDevice(device));  // a failure shows in the next call
}

/// An update fills the shared memory of a multiprocessor, so one block runs on each.
int32_t learners_at_once() {
  int multiprocessors = 1;
  if (cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, used) != cudaSuccess) return 1;
  return multiprocessors;
}

/// The resources that a kernel needs, with this much shared memory.
template <class Kernel>
std::string describe_kernel(const char* name, int64_t floats) {
  const size_t bytes = static_cast<size_t>(floats) * sizeof(float);
  cudaFuncAttributes needs{};
  int blocks = 0;
  static_cast<void>(
      cudaFuncSetAttribute(run_kernel<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytes)));
  static_cast<void>(cudaFuncGetAttributes(&needs, run_kernel<Kernel>));
  static_cast<void>(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, run_kernel<Kernel>, BLOCK_THREADS, bytes));
  char text[200];
  snprintf(text, sizeof text, "\"%s\": {\"registers\": %d, \"local_bytes\": %d, \"shared_bytes\": %d, \"blocks\": %d}",
           name, needs.numRegs, static_cast<int>(needs.localSizeBytes), static_cast<int>(bytes), blocks);
  return text;
}

const char* describe() {
  static thread_local std::string text;
  cudaDeviceProp is{};
  int driver = 0, runtime = 0, clock = 0;
  size_t available = 0, all = 0;
  if (cudaGetDeviceProperties(&is, used) != cudaSuccess) return "{}";
  static_cast<void>(cudaDriverGetVersion(&driver));
  static_cast<void>(cudaRuntimeGetVersion(&runtime));
  static_cast<void>(cudaDeviceGetAttribute(&clock, cudaDevAttrClockRate, used));
  static_cast<void>(cudaMemGetInfo(&available, &all));
  char line[400];
  snprintf(line, sizeof line,
           "{\"name\": \"%s\", \"variant\": \"%s\", \"devices\": %d, \"capability\": \"%d.%d\", \"multiprocessors\": "
           "%d, \"clock_khz\": %d, "
           "\"memory_bytes\": %zu, \"free_bytes\": %zu, \"driver\": %d, \"runtime\": %d, \"kernels\": {",
           is.name, VARIANT.name, count_devices(), is.major, is.minor, is.multiProcessorCount, clock, all, available,
           driver, runtime);
  text = line + describe_kernel<StepWorlds>("StepWorlds", StepWorlds::FLOATS) + ", " +
         describe_kernel<LearnWorlds>("LearnWorlds", learning_layout(params_of(95)).total) + ", " +
         describe_kernel<CloseWindows>("CloseWindows", CloseWindows::FLOATS) + "}}";
  return text.c_str();
}

void* reserve(int64_t bytes) {
  void* block = nullptr;
  const cudaError_t given = cudaMalloc(&block, static_cast<size_t>(bytes));
  return *text_of(given) == '\0' ? block : nullptr;
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
    if (first == cudaSuccess) first = start_timed(kernel, floats);
  });
  return text_of(first);
}

const char* finish_all(double* seconds) {
  const cudaError_t done = cudaDeviceSynchronize();
  for (const Lap& lap : laps_of[used]) {
    float milliseconds = 0.0f;
    if (done == cudaSuccess && cudaEventElapsedTime(&milliseconds, lap.begin, lap.end) == cudaSuccess)
      seconds[static_cast<int32_t>(lap.part)] += static_cast<double>(milliseconds) * 1e-3;
    static_cast<void>(cudaEventDestroy(lap.begin));
    static_cast<void>(cudaEventDestroy(lap.end));
  }
  laps_of[used].clear();
  return text_of(done);
}

const DeviceProgram PROGRAM = {
    "cuda",  device_layout(), WIDEST_NETWORK, open_devices, count_devices, use_device,  describe,   learners_at_once,
    reserve, release,         copy_in,        copy_out,     fill_kernel,   advance_all, finish_all,
};

}  // namespace
}  // namespace hedon

extern "C" __attribute__((visibility("default"))) const hedon::DeviceProgram* hedon_device() { return &hedon::PROGRAM; }
