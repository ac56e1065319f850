/// The system that a web page is. It cannot start a thread while a function of the module runs, so threads are there
/// before they are needed: a Web Worker for each takes a seat and serves there (`web/src/engine.js`). A seat has the
/// stack of its thread. Members of a team allocate nothing, so the allocator needs no lock.
#if defined(__wasm__)

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "base/platform.h"

#define HEDON_EXPORT(name) extern "C" __attribute__((export_name(#name), used))
#define HEDON_IMPORT(name) extern "C" __attribute__((import_module("page"), import_name(#name)))

namespace hedon {

// Sleeping is the page's, not the module's own instructions: with some shapes of code around them, V8's quick compiler
// (Node 20) loses their wakes.

/// Sleeps while `*word` is `value`, for a moment at most.
HEDON_IMPORT(sleep_while) void page_sleep_while(const void* word, uint32_t value);
/// Wakes all who sleep on a word.
HEDON_IMPORT(wake_all) void page_wake_all(const void* word);

namespace {

constexpr int SEATS = 16;
constexpr size_t STACK = size_t{1} << 20;  ///< bytes, as the first thread has

struct Seat {
  std::atomic<uint32_t> busy{0};
  std::function<void()> work;
};

Seat seats[SEATS];
int seated = 0;
std::atomic<uint32_t> stopped{0};  ///< the first thread that a trap has stopped, counted from 1; 0 for none

/// Where a thread has its own memory; the worker reads it as two 32-bit integers.
struct Place {
  void* stack;  ///< the upper end
  void* locals;
};
Place place;

}  // namespace

/// The allocator stops where it would have to ask for 2 GB or more at once, but it gives what lies free in one piece.
/// So it asks for the memory in parts, which lie one after the other, and become one piece as they are freed.
void* reserve_pages(size_t bytes) {
  constexpr size_t PART = size_t{1} << 28;
  constexpr size_t ROOM = 4096;  ///< for what the allocator notes of a block
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
  if (seat == end) abort();  // `available_processors` says how many threads there can be
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
    if (stopped.load() != 0) __builtin_trap();  // nobody would ever change the word
  }
}

void wake_all(std::atomic<uint32_t>& word) { page_wake_all(&word); }

/// Makes one more seat. Null if there are no more, or no memory for it.
HEDON_EXPORT(hedon_seat) const Place* hedon_seat() {
  if (seated == SEATS) return nullptr;
  const size_t locals = (__builtin_wasm_tls_size() + 63) / 64 * 64;
  char* block = static_cast<char*>(aligned_alloc(64, STACK + locals));
  if (block == nullptr) return nullptr;
  ++seated;
  place = {block + STACK, block + STACK};
  return &place;
}

/// What a worker does on a seat: one piece of work after the other. Returns never.
HEDON_EXPORT(hedon_serve) void hedon_serve(int32_t index) {
  Seat& seat = seats[index];
  for (;;) {
    sleep_while(seat.busy, 0);
    seat.work();
    seat.busy.store(0);
    wake_all(seat.busy);
  }
}

/// Tells the others that a thread, counted from 1, was stopped by a trap: any that wait are stopped too.
HEDON_EXPORT(hedon_stop) void hedon_stop(uint32_t thread) {
  uint32_t none = 0;
  stopped.compare_exchange_strong(none, thread);
}

/// The first thread that was stopped by a trap, counted from 1; 0 for none.
HEDON_EXPORT(hedon_stopped) uint32_t hedon_stopped() { return stopped.load(); }

}  // namespace hedon

#endif
