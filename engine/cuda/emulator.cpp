#include "cuda/emulator.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "cuda/thread.h"

#if defined(HEDON_SYSTEM_THREADS)
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/float_mode.h"
#else
#include <ucontext.h>
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif
#endif

namespace hedon {
namespace {

/// Waits until all members are there.
class Barrier {
 public:
  explicit Barrier(int size = 0) : size_(size) {}
  void wait();

 private:
  int size_;
  int waiting_ = 0;
  uint32_t phase_ = 0;
#if defined(HEDON_SYSTEM_THREADS)
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  std::unique_ptr<std::condition_variable> all_here_ = std::make_unique<std::condition_variable>();
#endif
};

/// Values exchanged by the threads of a tile. Two alternating sets, since a thread can be one exchange ahead.
struct Tile {
  Barrier barrier{TILE};
  uint32_t given[2][TILE];
};

struct EmulatedBlock {
  Barrier barrier;
  std::vector<Tile> tiles;
  std::unique_ptr<float[]> shared;
  int64_t floats;  ///< of shared memory
  int threads;
};

struct Thread {
  EmulatedBlock* block;
  int rank;
  int turn = 0;
  int64_t barriers = 0, tile_barriers = 0;  ///< reached so far
};

thread_local Thread* self = nullptr;

/// Shares a number with the tile; returns the numbers of all its threads.
const uint32_t* exchange(uint32_t number) {
  Tile& tile = self->block->tiles[static_cast<size_t>(self->rank / TILE)];
  uint32_t* const given = tile.given[self->turn];
  self->turn = 1 - self->turn;
  given[self->rank % TILE] = number;
  tile.barrier.wait();
  return given;
}

#if defined(HEDON_SYSTEM_THREADS)

void Barrier::wait() {
  std::unique_lock<std::mutex> lock(*mutex_);
  const uint32_t phase = phase_;
  if (++waiting_ == size_) {
    waiting_ = 0;
    ++phase_;
    all_here_->notify_all();
    return;
  }
  all_here_->wait(lock, [&] { return phase_ != phase; });
}

void run_threads(EmulatedBlock& block, const std::function<void()>& body) {
  std::vector<std::thread> threads;
  for (int rank = 0; rank < block.threads; ++rank) {
    threads.emplace_back([&, rank] {
      const FloatMode mode(false);
      Thread me{&block, rank};
      self = &me;
      body();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

#else

constexpr size_t STACK_BYTES = 256 * 1024;

/// A suspended stack. The address sanitizer must know which stack is in use.
struct Stack {
  const void* first = nullptr;
  size_t bytes = 0;
#if defined(__SANITIZE_ADDRESS__)
  void* frames = nullptr;

  /// Switches from this stack to another one; `last` if it will not be resumed.
  void leave_for(const Stack& to, bool last = false) {
    __sanitizer_start_switch_fiber(last ? nullptr : &frames, to.first, to.bytes);
  }
  /// Arrives on this stack; gets the address of the stack that was left.
  void arrive(Stack& from) { __sanitizer_finish_switch_fiber(frames, &from.first, &from.bytes); }
#else
  void leave_for(const Stack&, bool = false) {}
  void arrive(Stack&) {}
#endif
};

/// One thread of a block. It runs until it waits, and then the next one runs.
struct Fiber {
  Thread thread;
  Stack place;
  ucontext_t begin;
  jmp_buf at;
  std::unique_ptr<char[]> stack{new char[STACK_BYTES]};
  bool begun, done;
};

jmp_buf scheduler;
Stack scheduler_place;
std::vector<std::unique_ptr<Fiber> > fibers;
Fiber* running = nullptr;
const std::function<void()>* job = nullptr;
bool moved = false;  ///< whether any fiber made progress in this round

void begin_fiber() {
  running->place.arrive(scheduler_place);
  (*job)();
  running->done = true;
  moved = true;
  running->place.leave_for(scheduler_place, true);
  _longjmp(scheduler, 1);
}

void Barrier::wait() {
  const uint32_t phase = phase_;
  moved = true;
  if (++waiting_ == size_) {
    waiting_ = 0;
    ++phase_;
    return;
  }
  while (phase_ == phase) {
    if (_setjmp(running->at) == 0) {
      running->place.leave_for(scheduler_place);
      _longjmp(scheduler, 1);
    }
    running->place.arrive(scheduler_place);
  }
  moved = true;
}

void resume(Fiber& fiber) {
  running = &fiber;
  self = &fiber.thread;
  if (_setjmp(scheduler) != 0) return scheduler_place.arrive(fiber.place);
  scheduler_place.leave_for(fiber.place);
  if (fiber.begun) _longjmp(fiber.at, 1);
  fiber.begun = true;
  setcontext(&fiber.begin);
}

void run_threads(EmulatedBlock& block, const std::function<void()>& body) {
  job = &body;
  while (fibers.size() < static_cast<size_t>(block.threads)) fibers.push_back(std::make_unique<Fiber>());
  for (int rank = 0; rank < block.threads; ++rank) {
    Fiber& fiber = *fibers[static_cast<size_t>(rank)];
    fiber.thread = {&block, rank};
    fiber.place = {fiber.stack.get(), STACK_BYTES};
    fiber.begun = fiber.done = false;
    getcontext(&fiber.begin);
    fiber.begin.uc_stack.ss_sp = fiber.stack.get();
    fiber.begin.uc_stack.ss_size = STACK_BYTES;
    fiber.begin.uc_link = nullptr;
    makecontext(&fiber.begin, begin_fiber, 0);
  }
  for (int going = block.threads; going > 0;) {
    going = 0;
    moved = false;
    for (int rank = 0; rank < block.threads; ++rank) {
      Fiber& fiber = *fibers[static_cast<size_t>(rank)];
      if (fiber.done) continue;
      resume(fiber);
      going += !fiber.done;
    }
    if (going > 0 && !moved) {
      fprintf(stderr, "emulator: %d of %d threads wait at a barrier that the others do not reach\n", going,
              block.threads);
      abort();
    }
  }
}

#endif

}  // namespace

int thread_rank() { return self->rank; }
int thread_count() { return self->block->threads; }
void block_barrier() {
  if (self->barriers++ != lost_barrier) self->block->barrier.wait();
}
void tile_barrier() {
  if (self->tile_barriers++ != lost_tile_barrier)
    self->block->tiles[static_cast<size_t>(self->rank / TILE)].barrier.wait();
}
float* shared_memory() { return self->block->shared.get(); }
bool is_shared(const void* place) {
  const float* const first = shared_memory();
  return !std::less<const void*>{}(place, first) && std::less<const void*>{}(place, first + self->block->floats);
}

uint32_t tile_ballot(bool holds) {
  const uint32_t* const given = exchange(holds ? 1u : 0u);
  uint32_t bits = 0;
  for (int lane = 0; lane < TILE; ++lane) bits |= given[lane] << lane;
  return bits;
}

float tile_read(float value, int lane) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  bits = exchange(bits)[lane];
  memcpy(&value, &bits, sizeof value);
  return value;
}

void launch(int32_t blocks, int32_t threads, int64_t floats, const std::function<void(int32_t)>& kernel) {
  for (int32_t b = 0; b < blocks; ++b) {
    EmulatedBlock block;
    block.threads = threads;
    block.floats = floats;
    block.barrier = Barrier(threads);
    block.tiles = std::vector<Tile>(static_cast<size_t>(threads / TILE));
    block.shared.reset(new float[static_cast<size_t>(floats)]);
    memset(static_cast<void*>(block.shared.get()), 0xFF, static_cast<size_t>(floats) * sizeof(float));
    run_threads(block, [&] { kernel(b); });
  }
}

}  // namespace hedon
