/// Windows of the emulated CUDA kernels compared with the processor's kernel, without Python, for the sanitizers.
///
///     cuda_windows STEPS FILE…     two worlds of each file; digests after STEPS steps
///     cuda_windows --without N …   the same with an intended bug: no thread waits at the N-th barrier of its block or,
///     cuda_windows --without-tile N …   of its tile
///
/// Exit status 1 if a digest differs or a world has a fault, 2 if a file is invalid.
#include <cstring>

#include "cuda/emulator.h"
#include "world_file.h"

namespace hedon {
namespace {

constexpr int WORLDS = 2;

/// Whether the worlds of a file have the same bits on both backends after `steps` steps.
bool same(const std::string& file, int64_t steps) {
  const WorldInput input = read_world(file, WORLDS);
  const auto here = make_worlds(input, WORLDS, false), there = make_worlds(input, WORLDS, true);
  here->run(steps);
  there->run(steps);
  bool equal = true;
  for (int i = 0; i < WORLDS; ++i) {
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
  for (; count > next + 3; next += 2) {
    if (strcmp(arguments[next], "--without") == 0)
      hedon::lost_barrier = atoll(arguments[next + 1]);
    else if (strcmp(arguments[next], "--without-tile") == 0)
      hedon::lost_tile_barrier = atoll(arguments[next + 1]);
    else
      break;
  }
  if (count < next + 2) {
    fprintf(stderr, "cuda_windows [--without N] [--without-tile N] STEPS FILE…\n");
    return 2;
  }
  const int64_t steps = atoll(arguments[next]);
  bool equal = true;
  for (int i = next + 1; i < count; ++i) equal = hedon::same(arguments[i], steps) && equal;
  return equal ? 0 : 1;
}
