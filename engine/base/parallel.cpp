#include "base/parallel.h"

#include <sched.h>
#include <unistd.h>

namespace hedon {
namespace {

/// Rounds to nearest and flushes denormals to zero while it lives, then restores what the thread had: other libraries
/// change these, and Adam's fading moments would otherwise crawl through denormal numbers.
class FloatMode {
 public:
#if defined(__SSE__)
  FloatMode() : saved_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(0x9fc0);
  }  // all exceptions masked, FTZ, DAZ, nearest
  ~FloatMode() { __builtin_ia32_ldmxcsr(saved_); }

 private:
  unsigned saved_;
#else
  FloatMode() {}
#endif
};

}  // namespace

int available_processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  const unsigned count = std::thread::hardware_concurrency();
  return count > 0 ? static_cast<int>(count) : 1;
}

Pool::Pool(int size) : process_(getpid()) {
  threads_.reserve(static_cast<size_t>(size - 1));
  for (int rank = 1; rank < size; ++rank) threads_.emplace_back([this, rank] { work(rank); });
}

Pool::~Pool() {
  if (forked()) {
    for (std::thread& thread : threads_) thread.detach();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool Pool::forked() const { return getpid() != process_; }

void Pool::run(const std::function<void(int)>& job) {
  {
    const std::lock_guard lock(mutex_);
    job_ = &job;
    busy_ = size() - 1;
    ++round_;
  }
  wake_.notify_all();
  {
    const FloatMode mode;
    job(0);
  }
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void Pool::work(int rank) {
  const FloatMode mode;
  uint64_t seen = 0;
  for (;;) {
    const std::function<void(int)>* job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stop_ || round_ != seen; });
      if (stop_) return;
      seen = round_;
      job = job_;
    }
    (*job)(rank);
    {
      const std::lock_guard lock(mutex_);
      if (--busy_ == 0) done_.notify_one();
    }
  }
}

}  // namespace hedon
