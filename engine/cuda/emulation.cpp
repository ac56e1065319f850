/// The device of the tests: the kernels of CUDA, run by the emulator.
#include "base/float_mode.h"
#include "cuda/emulator.h"
#include "cuda/window.h"

#include <cstdlib>

namespace hedon {
namespace {

constexpr int32_t LEARNERS_AT_ONCE = 2;  ///< several, so that blocks take learners in turn

/// Runs a kernel as CUDA does: all its blocks.
template <class Kernel>
void emulate(const Kernel& kernel, int64_t floats) {
  launch(kernel.blocks(), BLOCK_THREADS, floats, [&](int32_t block) { kernel(block); });
}

const char* advance(const DeviceWorlds& worlds, int64_t step, int64_t steps) {
  const FloatMode mode(false);  // a device keeps denormals
  advance_worlds(worlds, step, steps, [](const auto& kernel, int64_t floats) { emulate(kernel, floats); });
  return "";
}

const DeviceProgram PROGRAM = {
    "cuda-emulated",
    device_layout(),
    WIDEST_NETWORK,
    [] { return ""; },
    [] { return LEARNERS_AT_ONCE; },
    [](int64_t bytes) { return aligned_alloc(64, static_cast<size_t>((bytes + 63) / 64 * 64)); },
    free,
    [](void* to, const void* from, int64_t bytes) {
      memcpy(to, from, static_cast<size_t>(bytes));
      return "";
    },
    [](void* to, const void* from, int64_t bytes) {
      memcpy(to, from, static_cast<size_t>(bytes));
      return "";
    },
    [](Kernel* kernel) {
      emulate(FillKernel{kernel}, FillKernel::FLOATS);
      return "";
    },
    advance,
};

}  // namespace
}  // namespace hedon

extern "C" __attribute__((visibility("default"))) const hedon::DeviceProgram* hedon_device() { return &hedon::PROGRAM; }
