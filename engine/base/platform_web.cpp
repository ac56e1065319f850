/// The platform for web pages. A page cannot start a thread while a function of the module runs, so threads are started
/// in advance: a Web Worker for each takes a seat and serves there (`web/src/engine.js`). A seat has the stack of its
/// thread. Members of a team allocate nothing, so the allocator needs no lock.
#if defined(__wasm__)

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "base/platform.h"

#define HEDON_EXPORT(name) extern "C" __attribute__((export_name(#name), used))
#define HEDON_IMPORT(name) extern "C" __attribute__((import_module("page"), import_name(#name)))

namespace hedon {

// The page implements sleeping, not the module's own instructions: with some code around these, V8's baseline compiler
// (Node 20) loses wake-ups.

/// Sleeps while `*word` is `value`, but only for a moment.
HEDON_IMPORT(sleep_while) void page_sleep_while(const void* word, uint32_t value);
/// Wakes all threads that sleep on a word.
HEDON_IMPORT(wake_all) void page_wake_all(const void* word);

namespace {

constexpr int SEATS = 16;
constexpr size_t STACK = size_t{1} << 20;  ///< bytes, as for the first thread

struct Seat {
  std::atomic<uint32_t> busy{0};
  std::function<void()> work;
};

Seat seats[SEATS];
int seated = 0;
std::atomic<uint32_t> stopped{0};  ///< the first thread that a trap has stopped, counted from 1; 0 for none

/// The addresses of a thread's own memory, which the worker reads as two 32-bit integers.
struct Place {
  void* stack;  ///< the upper end
  void* locals;
};
Place place;

}  // namespace

/// The allocator fails if it has to request 2 GB or more at once, but it can return any free block that is contiguous.
/// So this requests the memory in consecutive parts, which become one block when they are freed.
void* reserve_pages(size_t bytes) {
  constexpr size_t PART = size_t{1} << 28;
  constexpr size_t ROOM = 4096;  ///< for the allocator's header of a block
  if (bytes > SIZE_MAX - ROOM) return nullptr;
  void* parts[SIZE_MAX / PART + 1];
  int count = 0;
  bool there = true;
  for (size_t left = bytes + ROOM; left > 0 && there; left -= std::min(left, PART)) {
    parts[count] = malloc(std::min(left, PART));
    there = parts[count] != nullptr;
    count += there ? 1 : 0;
  }
  while (count > 0) free(parts[--count]);
  return there ? calloc(bytes, 1) : nullptr;
}

void release_pages(void* block, size_t) { free(block); }

int64_t back_with_file(void*, size_t, const char*) { return -ENOTSUP; }

void expect_in_file(const void*, size_t) {}

void forget_in_file(int64_t, int64_t, int64_t) {}

void close_file(int64_t) {}

int available_processors() { return 1 + seated; }

int64_t current_process() { return 0; }

struct Thread::Handle {
  Seat* seat;
};

Thread::Thread(std::function<void()> work) {
  Seat* const end = seats + seated;
  Seat* const seat = std::find_if(seats, end, [](const Seat& each) { return !each.work; });
  if (seat == end) abort();  // `available_processors` limits the number of threads
  handle_ = std::make_unique<Handle>(Handle{seat});
  seat->work = std::move(work);
  seat->busy.store(1);
  wake_all(seat->busy);
}

Thread::~Thread() {
  sleep_while(handle_->seat->busy, 1);
  handle_->seat->work = nullptr;
}

void sleep_while(const std::atomic<uint32_t>& word, uint32_t value) {
  while (word.load() == value) {
    page_sleep_while(&word, value);
    if (stopped.load() != 0) __builtin_trap();  // otherwise the word would never change
  }
}

void wake_all(std::atomic<uint32_t>& word) { page_wake_all(&word); }

/// Makes one more seat. Null if there are no more seats, or no memory for it.
HEDON_EXPORT(hedon_seat) const Place* hedon_seat() {
  if (seated == SEATS) return nullptr;
  const size_t locals = (__builtin_wasm_tls_size() + 63) / 64 * 64;
  char* block = static_cast<char*>(aligned_alloc(64, STACK + locals));
  if (block == nullptr) return nullptr;
  ++seated;
  place = {block + STACK, block + STACK};
  return &place;
}

/// Called by the worker of a seat: does one piece of work after another and never returns.
HEDON_EXPORT(hedon_serve) void hedon_serve(int32_t index) {
  Seat& seat = seats[index];
  for (;;) {
    sleep_while(seat.busy, 0);
    seat.work();
    seat.busy.store(0);
    wake_all(seat.busy);
  }
}

/// Records that a trap has stopped a thread, counted from 1, so that all waiting threads stop too.
HEDON_EXPORT(hedon_stop) void hedon_stop(uint32_t thread) {
  uint32_t none = 0;
  stopped.compare_exchange_strong(none, thread);
}

/// The first thread that was stopped by a trap, counted from 1; 0 for none.
HEDON_EXPORT(hedon_stopped) uint32_t hedon_stopped() { return stopped.load(); }

}  // namespace hedon

#endif
