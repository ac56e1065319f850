/// Threads that run the same code over the same world: the group for which every step rule is written.
///
/// Each member calls the same functions. `for_each` and `once` end with a barrier, so a phase can read what the phase
/// before it wrote. A loop body writes only data of its own index, so results do not depend on the size of the team.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/crew.h"
#include "base/platform.h"

namespace hedon {

/// Data that the members of a team share.
struct TeamState {
  std::atomic<int> waiting{0};
  std::atomic<uint32_t> phase{0};
  std::atomic<int> next{0};
  int size = 1;
};

class Team {
 public:
  Team(TeamState& state, int rank) : state_(&state), rank_(rank), size_(state.size) {}

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// Waits until all members arrive. First spins, since phases last microseconds; then sleeps, because if other
  /// programs use the processors too, a spinning member can keep the member that it waits for from running.
  void barrier() {
    if (size_ == 1) return;
    const uint32_t phase = state_->phase.load(std::memory_order_relaxed);
    if (state_->waiting.fetch_add(1, std::memory_order_acq_rel) == size_ - 1) {
      state_->waiting.store(0, std::memory_order_relaxed);
      state_->next.store(0, std::memory_order_relaxed);
      // Sequentially consistent, with a full fence: the notification checks whether any member sleeps. It must check
      // after the new phase is visible; otherwise a member that falls asleep in between never wakes.
      state_->phase.store(phase + 1, std::memory_order_seq_cst);
      wake_all(state_->phase);
      return;
    }
    for (int spin = 0; spin < SPINS; ++spin) {
      if (state_->phase.load(std::memory_order_acquire) != phase) return;
      relax();
    }
    sleep_while(state_->phase, phase);
  }

  /// Calls body(i) for i in [0, count), in contiguous blocks of nearly equal size: for many small equal pieces.
  template <class Body>
  void for_each(int count, Body&& body) {
    const int first = static_cast<int>(static_cast<int64_t>(count) * rank_ / size_);
    const int last = static_cast<int>(static_cast<int64_t>(count) * (rank_ + 1) / size_);
    for (int i = first; i < last; ++i) body(i);
    barrier();
  }

  /// Calls body(crew, i) for i in [0, count), like `for_each`: each member is a crew of its own.
  template <class Body>
  void for_each_by_crew(int count, Body&& body) {
    for_each(count, [&](int i) { body(Alone{}, i); });
  }

  /// The same, but each member runs through its block backward.
  template <class Body>
  void for_each_backward(int count, Body&& body) {
    const int first = static_cast<int>(static_cast<int64_t>(count) * rank_ / size_);
    const int last = static_cast<int>(static_cast<int64_t>(count) * (rank_ + 1) / size_);
    for (int i = last - 1; i >= first; --i) body(i);
    barrier();
  }

  /// Calls body(i) for i in [0, count); each free member takes the next i: for few large or unequal pieces.
  template <class Body>
  void for_each_claimed(int count, Body&& body) {
    if (size_ == 1) {
      for (int i = 0; i < count; ++i) body(i);
      return;
    }
    for (int i = state_->next.fetch_add(1, std::memory_order_relaxed); i < count;
         i = state_->next.fetch_add(1, std::memory_order_relaxed)) {
      body(i);
    }
    barrier();
  }

  /// Calls body(crew) with one crew.
  template <class Body>
  void together(Body&& body) {
    once([&] { body(Alone{}); });
  }

  /// The scratch memory of a step. Blocks of a device copy it to their shared memory: see `cuda/stage.h`.
  template <class Scratch, class List>
  const Scratch& stage(const Scratch& scratch, const List&) const {
    return scratch;
  }

  /// Calls body() on one member while the others wait.
  template <class Body>
  void once(Body&& body) {
    if (rank_ == 0) body();
    barrier();
  }

 private:
  static constexpr int SPINS = 2000;  ///< about 25 µs, longer than the phases in which only one member works

  static void relax() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("isb");  // waits about as long as x86's pause; ARM's yield waits for nothing on most processors
#endif
  }

  TeamState* state_;
  int rank_;
  int size_;
};

}  // namespace hedon
