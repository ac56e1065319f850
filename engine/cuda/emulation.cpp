/// The device of the tests: the kernels of CUDA, run by the emulator.
#include "base/float_mode.h"
#include "cuda/emulator.h"
#include "cuda/schedule.h"
#include "cuda/window.h"

#include <chrono>
#include <cstdlib>
#include <string>
#include <type_traits>

namespace hedon {
namespace {

constexpr int32_t LEARNERS_AT_ONCE = 2;  ///< several, so that blocks take learners in turn
constexpr int32_t DEVICES = 2;           ///< several, so that worlds are divided among them

int32_t used = 0;
double seconds_of[DEVICES][DEVICE_PARTS];
int64_t runs_left = -1;   ///< until the device is lost; negative for never
int64_t most_bytes = -1;  ///< largest allocation; negative for no limit

bool lost() { return runs_left == 0; }

const char* answer() { return lost() ? "the emulated device is lost" : ""; }

/// Runs a kernel as CUDA does: all its blocks.
template <class Kernel>
void emulate(const Kernel& kernel, int64_t floats) {
  launch(kernel.blocks(), BLOCK_THREADS, floats, [&](int32_t block) { kernel(block); });
}

const char* advance(const DeviceWorlds& worlds, int64_t step, int64_t steps) {
  using Clock = std::chrono::steady_clock;
  if (runs_left > 0) --runs_left;
  if (lost()) return "";        // as on a device, where a failure shows at the next wait
  const FloatMode mode(false);  // a device keeps denormals
  Schedule schedule;
  advance_worlds(worlds, step, steps, [&](int32_t group, const auto& kernel, int64_t floats) {
    const int32_t part = static_cast<int32_t>(std::remove_cvref_t<decltype(kernel)>::PART);
    double& seconds = seconds_of[used][part];
    schedule.add(group, part, [=, &seconds] {
      const Clock::time_point begun = Clock::now();
      emulate(kernel, floats);
      seconds += std::chrono::duration<double>(Clock::now() - begun).count();
    });
  });
  schedule.run();
  return "";
}

const char* finish(double* seconds) {
  for (int32_t part = 0; part < DEVICE_PARTS; ++part) {
    seconds[part] += seconds_of[used][part];
    seconds_of[used][part] = 0.0;
  }
  return answer();
}

void* reserve(int64_t bytes) {
  if (most_bytes >= 0 && bytes > most_bytes) return nullptr;
  return aligned_alloc(64, static_cast<size_t>((bytes + 63) / 64 * 64));
}

const char* copy(void* to, const void* from, int64_t bytes) {
  if (!lost()) memcpy(to, from, static_cast<size_t>(bytes));
  return answer();
}

const char* fill_kernel(Kernel* kernel) {
  emulate(FillKernel{kernel}, FillKernel::FLOATS);
  return "";
}

const std::string DESCRIPTION =
    std::string("{\"name\": \"emulation on the processor\", \"variant\": \"") + VARIANT.name + "\"}";

const DeviceProgram PROGRAM = {
    "cuda-emulated",
    device_layout(),
    WIDEST_NETWORK,
    [] { return ""; },
    [] { return DEVICES; },
    [](int32_t device) { used = device; },
    [] { return DESCRIPTION.c_str(); },
    [] { return LEARNERS_AT_ONCE; },
    reserve,
    free,
    copy,
    copy,
    fill_kernel,
    advance,
    finish,
};

}  // namespace
}  // namespace hedon

extern "C" __attribute__((visibility("default"))) const hedon::DeviceProgram* hedon_device() { return &hedon::PROGRAM; }

/// For tests of failures: the devices are lost in the N-th run from now, and allocate at most this many bytes at once.
extern "C" __attribute__((visibility("default"))) void hedon_emulation_fails(int64_t run, int64_t bytes) {
  hedon::runs_left = run;
  hedon::most_bytes = bytes;
}
