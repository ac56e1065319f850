/// The order of the emulated kernels of several groups of worlds, which streams and events determine on a device.
///
/// A kernel waits for the previous kernel of its group and for the previous one of its part. If the emulator's threads
/// are threads of the system, kernels that do not wait for one another run at the same time, so the thread sanitizer
/// detects what groups share. Otherwise the last group that can run does, which is not the order in which kernels were
/// added.
#pragma once

#include <functional>
#include <vector>

#if defined(HEDON_SYSTEM_THREADS)
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/float_mode.h"
#endif

namespace hedon {

class Schedule {
 public:
  void add(int group, int part, std::function<void()> kernel) {
    const auto last = [&](auto&& holds) {
      for (size_t i = entries_.size(); i-- > 0;) {
        if (holds(entries_[i])) return static_cast<int>(i);
      }
      return -1;
    };
    const int of_group = last([&](const Entry& entry) { return entry.group == group; });
    const int of_part = last([&](const Entry& entry) { return entry.part == part; });
    entries_.push_back({group, part, of_group, of_part, false, std::move(kernel)});
  }

  /// Runs all kernels.
  void run();

 private:
  struct Entry {
    int group, part;
    int of_group, of_part;  ///< what it waits for; -1 for nothing
    bool done;
    std::function<void()> kernel;
  };

  bool is_done(int i) const { return i < 0 || entries_[static_cast<size_t>(i)].done; }
  bool is_ready(const Entry& entry) const { return !entry.done && is_done(entry.of_group) && is_done(entry.of_part); }

  std::vector<Entry> entries_;
};

#if defined(HEDON_SYSTEM_THREADS)

inline void Schedule::run() {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::thread> threads;
  for (Entry& entry : entries_) {
    threads.emplace_back([&] {
      const FloatMode mode(false);
      {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [&] { return is_ready(entry); });
      }
      entry.kernel();
      const std::lock_guard<std::mutex> lock(mutex);
      entry.done = true;
      changed.notify_all();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

#else

inline void Schedule::run() {
  for (size_t left = entries_.size(); left > 0; --left) {
    Entry* next = nullptr;
    for (Entry& entry : entries_) {
      if (is_ready(entry) && (next == nullptr || entry.group > next->group)) next = &entry;
    }
    next->kernel();
    next->done = true;
  }
}

#endif

}  // namespace hedon
