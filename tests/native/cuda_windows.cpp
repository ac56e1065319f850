/// Windows of the emulated CUDA kernels against the processor's kernel, without Python: for the sanitizers.
///
///     cuda_windows STEPS FILE…     a world for each file, with `engine/web/input.h`'s text; digests after STEPS steps
///     cuda_windows --without N …   the same, with a mistake: no thread waits at the N-th barrier of its block
///
/// Exit status 1 where a digest differs or a world has a fault, 2 for a wrong file.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "cuda/emulator.h"
#include "simulation/config_check.h"
#include "simulation/simulation.h"
#include "web/input.h"

extern "C" const hedon::DeviceProgram* hedon_device();

namespace hedon {
namespace {

constexpr int THREADS = 4;  ///< of the processor: more than worlds, so that teams of two step them

std::unique_ptr<Simulation> make(const WorldInput& input, const DeviceProgram* program) {
  const std::vector<uint64_t> seeds{input.seed, input.seed + 1};
  return std::make_unique<Simulation>(input.config, input.walls, static_cast<int32_t>(input.outer_walls), seeds,
                                      THREADS, find_kernel("avx2"), std::vector<int32_t>{}, true, program);
}

/// Whether two worlds of the text in `file` have the same bits on both sides after `steps` steps.
bool same(const std::string& file, int64_t steps) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  WorldInput input;
  std::string wrong = read_input(text.str(), input);
  if (wrong.empty()) wrong = check_config(input.config);
  if (wrong.empty()) wrong = check_company(input.config, input.walls, input.outer_walls, 2, THREADS, {});
  if (!wrong.empty()) {
    fprintf(stderr, "%s: %s\n", file.c_str(), wrong.c_str());
    exit(2);
  }
  const auto here = make(input, nullptr), there = make(input, hedon_device());
  here->run(steps);
  there->run(steps);
  bool equal = true;
  for (int i = 0; i < here->world_count(); ++i) {
    const World& world = there->complete(i);
    const bool sound = world.fault().status == Status::ok && here->digest(i) == there->digest(i);
    printf("%s: world %d, step %lld, %d alive, %s\n", file.c_str(), i, static_cast<long long>(world.head().step),
           world.head().living_count, sound ? "the same bits" : "OTHER BITS OR A FAULT");
    equal = equal && sound;
  }
  return equal;
}

}  // namespace
}  // namespace hedon

int main(int count, char** arguments) {
  int next = 1;
  if (count > 3 && strcmp(arguments[1], "--without") == 0) {
    hedon::lost_barrier = atoll(arguments[2]);
    next = 3;
  }
  if (count < next + 2) {
    fprintf(stderr, "cuda_windows [--without N] STEPS FILE…\n");
    return 2;
  }
  const int64_t steps = atoll(arguments[next]);
  bool equal = true;
  for (int i = next + 1; i < count; ++i) equal = hedon::same(arguments[i], steps) && equal;
  return equal ? 0 : 1;
}
