/// The library of a CUDA device: the kernels of `window.h`, run by CUDA's runtime.
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

#include "cuda/window.h"

namespace hedon {
namespace {

constexpr int32_t MAX_DEVICES = 64;
// Of compute capability 9.0. Source: CUDA C++ Programming Guide, table of technical specifications.
constexpr int64_t MULTIPROCESSOR_BYTES = 228 * 1024;  ///< of shared memory
constexpr int64_t BLOCK_BYTES = 1024;                 ///< of it, that each block takes for itself

template <class Kernel>
__global__ void __launch_bounds__(BLOCK_THREADS, VARIANT.together) run_kernel(const Kernel kernel) {
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
  int32_t group;
  cudaEvent_t begin = nullptr, end = nullptr;
};

thread_local int32_t used = 0;
thread_local int32_t carveout = 100;  ///< percent of a multiprocessor's memory that kernels ask for as shared memory
std::vector<Lap> laps_of[MAX_DEVICES];
cudaStream_t streams_of[MAX_DEVICES][DEVICE_PARTS] = {};  ///< null, the stream of copies, until they are needed

/// The part that the blocks take that run side by side: updates, or one update and one block that steps.
int32_t carveout_of(int64_t learning_floats) {
  const auto bytes = [](int64_t floats) { return floats * static_cast<int64_t>(sizeof(float)) + BLOCK_BYTES; };
  const int64_t learn = bytes(learning_floats);
  const int64_t most = std::max(VARIANT.learners * learn, learn + bytes(StepWorlds::FLOATS));
  return static_cast<int32_t>(std::min<int64_t>(100, (most * 100 + MULTIPROCESSOR_BYTES - 1) / MULTIPROCESSOR_BYTES));
}

/// Lets a kernel have this much shared memory. Blocks share a multiprocessor only if they divide its memory in the same
/// way into shared memory and cache; so what runs side by side asks for the same.
template <class Kernel>
cudaError_t allow_shared(int bytes) {
  cudaError_t first = cudaFuncSetAttribute(run_kernel<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes);
  if constexpr (VARIANT.overlap || (VARIANT.learners > 1 && std::is_same_v<Kernel, LearnWorlds>)) {
    if (first == cudaSuccess)
      first = cudaFuncSetAttribute(run_kernel<Kernel>, cudaFuncAttributePreferredSharedMemoryCarveout, carveout);
  }
  return first;
}

/// Starts a kernel after those before it in its stream. Only the first failure of several launches is of interest.
template <class Kernel>
cudaError_t start(const Kernel& kernel, int64_t floats, cudaStream_t stream) {
  const int bytes = static_cast<int>(floats * static_cast<int64_t>(sizeof(float)));
  const cudaError_t allowed = allow_shared<Kernel>(bytes);
  if (allowed != cudaSuccess) return allowed;
  run_kernel<<<static_cast<unsigned>(kernel.blocks()), BLOCK_THREADS, static_cast<size_t>(bytes), stream>>>(kernel);
  return cudaGetLastError();
}

/// The stream of a part. All wait for the copies before, and these for them. Steps go first: the blocks of updates
/// could take all room, and stay until the last learner is done.
cudaError_t find_stream(DevicePart part, cudaStream_t& stream) {
  cudaStream_t& kept = streams_of[used][static_cast<int32_t>(part)];
  cudaError_t first = cudaSuccess;
  if (VARIANT.overlap && kept == nullptr) {
    int lowest = 0, highest = 0;
    first = cudaDeviceGetStreamPriorityRange(&lowest, &highest);
    if (first == cudaSuccess)
      first = cudaStreamCreateWithPriority(&kept, cudaStreamDefault, part == DevicePart::step ? highest : lowest);
  }
  stream = kept;
  return first;
}

/// The same after the last kernel of its group of worlds, with a note of the moments before and after it.
template <class Kernel>
cudaError_t start_timed(int32_t group, const Kernel& kernel, int64_t floats) {
  Lap lap{Kernel::PART, group};
  cudaStream_t stream = nullptr;
  cudaError_t first = find_stream(Kernel::PART, stream);
  std::vector<Lap>& laps = laps_of[used];
  const auto last = std::find_if(laps.rbegin(), laps.rend(), [&](const Lap& each) { return each.group == group; });
  if (VARIANT.overlap && first == cudaSuccess && last != laps.rend()) first = cudaStreamWaitEvent(stream, last->end);
  if (first == cudaSuccess) first = cudaEventCreate(&lap.begin);
  if (first == cudaSuccess) first = cudaEventCreate(&lap.end);
  if (first == cudaSuccess) first = cudaEventRecord(lap.begin, stream);
  if (first == cudaSuccess) first = start(kernel, floats, stream);
  if (first == cudaSuccess) first = cudaEventRecord(lap.end, stream);
  laps.push_back(lap);
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

/// As many blocks on each multiprocessor as the variant has room for.
int32_t learners_at_once() {
  int multiprocessors = 1;
  if (cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, used) != cudaSuccess) return 1;
  return multiprocessors * VARIANT.learners;
}

/// The resources that a kernel needs, with this much shared memory.
template <class Kernel>
std::string describe_kernel(const char* name, int64_t floats) {
  const size_t bytes = static_cast<size_t>(floats) * sizeof(float);
  cudaFuncAttributes needs{};
  int blocks = 0;
  static_cast<void>(allow_shared<Kernel>(static_cast<int>(bytes)));
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
  const cudaError_t started = start(FillKernel{kernel}, FillKernel::FLOATS, nullptr);
  return text_of(started != cudaSuccess ? started : cudaDeviceSynchronize());
}

const char* advance_all(const DeviceWorlds& worlds, int64_t step, int64_t steps) {
  carveout = carveout_of(learning_floats(worlds));
  cudaError_t first = cudaSuccess;
  advance_worlds(worlds, step, steps, [&](int32_t group, const auto& kernel, int64_t floats) {
    if (first == cudaSuccess) first = start_timed(group, kernel, floats);
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
