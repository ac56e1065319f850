/// Counts how often the threads of an emulated block access memory in a step of a world, and how long its longest path
/// is.
///
///     step_accesses WARM STEPS FILE
///
/// The world runs WARM steps on the processor, then STEPS in the emulation. Between two barriers, a device waits for
/// the thread with the longest path: a path counts the thread's own accesses, and each barrier, ballot or read of its
/// tile sets it to the longest path of the tile. Each barrier in the code gets a line: its address and, for the work
/// before it, per step, how often it occurred, the longest path, the longest path without accesses to shared memory,
/// and the accesses of the thread with the most, of the thread with the second most, and of all threads.
///
/// The emulation is compiled for the thread sanitizer, whose functions, called at each access, are defined below. The
/// linker sends calls of functions that wait through `__wrap_…`. `tests/cuda_step.py` builds everything.
#include <algorithm>
#include <map>

#include "base/float_mode.h"
#include "cuda/emulator.h"
#include "cuda/thread.h"
#include "world_file.h"

namespace {

struct Work {
  int64_t calls, way, global_way, most, second, all;
};

constexpr int MOST_THREADS = 1024;
bool counting = false;
int arrived = 0;
int arrived_of_tile[MOST_THREADS / hedon::TILE];
int64_t way[MOST_THREADS];         ///< path of each thread since the block's last barrier
int64_t global_way[MOST_THREADS];  ///< the same without accesses to shared memory
int64_t touched[MOST_THREADS];     ///< accesses of each thread itself
std::map<const void*, Work> before_barrier;

void touch(const void* place) {
  if (!counting) return;
  ++way[hedon::thread_rank()];
  global_way[hedon::thread_rank()] += !hedon::is_shared(place);
  ++touched[hedon::thread_rank()];
}

void close(Work& work, int threads) {
  std::sort(touched, touched + threads);
  work.calls += 1;
  work.way += *std::max_element(way, way + threads);
  work.global_way += *std::max_element(global_way, global_way + threads);
  work.most += touched[threads - 1];
  work.second += touched[threads - 2];
  for (int i = 0; i < threads; ++i) work.all += touched[i];
  std::fill_n(way, threads, 0);
  std::fill_n(global_way, threads, 0);
  std::fill_n(touched, threads, 0);
}

/// All threads of a tile wait for the one with the longest path.
void meet_in_tile() {
  const int tile = hedon::thread_rank() / hedon::TILE;
  if (!counting || ++arrived_of_tile[tile] < hedon::TILE) return;
  arrived_of_tile[tile] = 0;
  for (int64_t* const ways : {way, global_way}) {
    int64_t* const first = ways + tile * hedon::TILE;
    std::fill_n(first, hedon::TILE, *std::max_element(first, first + hedon::TILE));
  }
}

}  // namespace

extern "C" {
#define HEDON_TOUCH(name)                               \
  void __tsan_read##name(void* place) { touch(place); } \
  void __tsan_write##name(void* place) { touch(place); }
HEDON_TOUCH(1)
HEDON_TOUCH(2)
HEDON_TOUCH(4)
HEDON_TOUCH(8)
HEDON_TOUCH(16)
void __tsan_read_range(void* place, unsigned long) { touch(place); }
void __tsan_write_range(void* place, unsigned long) { touch(place); }
void __tsan_func_entry(void*) {}
void __tsan_func_exit() {}
void __tsan_init() {}
int32_t __tsan_atomic32_exchange(volatile int32_t* place, int32_t value, int) {
  touch(const_cast<const int32_t*>(place));
  return __atomic_exchange_n(place, value, __ATOMIC_RELAXED);
}
uint64_t __tsan_atomic64_fetch_or(volatile uint64_t* word, uint64_t bits, int) {
  touch(const_cast<const uint64_t*>(word));
  return __atomic_fetch_or(word, bits, __ATOMIC_RELAXED);
}

void __real__ZN5hedon13block_barrierEv();
void __wrap__ZN5hedon13block_barrierEv() {
  if (counting && ++arrived == hedon::thread_count()) {
    arrived = 0;
    close(before_barrier[__builtin_return_address(0)], hedon::thread_count());
  }
  __real__ZN5hedon13block_barrierEv();
}

void __real__ZN5hedon12tile_barrierEv();
void __wrap__ZN5hedon12tile_barrierEv() {
  meet_in_tile();
  __real__ZN5hedon12tile_barrierEv();
}

uint32_t __real__ZN5hedon11tile_ballotEb(bool holds);
uint32_t __wrap__ZN5hedon11tile_ballotEb(bool holds) {
  meet_in_tile();
  return __real__ZN5hedon11tile_ballotEb(holds);
}

float __real__ZN5hedon9tile_readEfi(float value, int lane);
float __wrap__ZN5hedon9tile_readEfi(float value, int lane) {
  meet_in_tile();
  return __real__ZN5hedon9tile_readEfi(value, lane);
}
}

int main(int count, char** arguments) {
  if (count != 4) {
    fprintf(stderr, "step_accesses WARM STEPS FILE\n");
    return 2;
  }
  const int64_t warm = atoll(arguments[1]), steps = atoll(arguments[2]);
  const hedon::WorldInput input = hedon::read_world(arguments[3], 1);
  const auto here = hedon::make_worlds(input, 1, false), there = hedon::make_worlds(input, 1, true);
  here->run(warm);
  const std::string wrong = there->restore(0, here->save(0));
  if (!wrong.empty()) {
    fprintf(stderr, "%s\n", wrong.c_str());
    return 2;
  }
  counting = true;
  there->run(steps);
  counting = false;
  here->run(steps);
  if (here->digest(0) != there->digest(0)) {
    fprintf(stderr, "the emulation has other bits than the processor\n");
    return 1;
  }
  printf("alive %d\n", there->numbers(0).head().living_count);
  const double per = 1.0 / static_cast<double>(steps);
  for (const auto& [address, work] : before_barrier)
    printf("%p %.3f %.1f %.1f %.1f %.1f %.1f\n", address, static_cast<double>(work.calls) * per,
           static_cast<double>(work.way) * per, static_cast<double>(work.global_way) * per,
           static_cast<double>(work.most) * per, static_cast<double>(work.second) * per,
           static_cast<double>(work.all) * per);
  return 0;
}
