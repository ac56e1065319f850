#if !defined(__wasm__)  // see parallel_single.cpp

#include "base/parallel.h"

#include <sched.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/float_mode.h"

namespace hedon {

int available_processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  const unsigned count = std::thread::hardware_concurrency();
  return count > 0 ? static_cast<int>(count) : 1;
}

/// What the threads wait on.
struct Pool::Shared {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable wake, done;
  const std::function<void(int)>* job = nullptr;
  uint64_t round = 0;
  int busy = 0;
  bool stop = false;
  bool flush;
};

Pool::Pool(int size, bool flush) : size_(size), process_(getpid()), shared_(std::make_unique<Shared>()) {
  shared_->flush = flush;
  shared_->threads.reserve(static_cast<size_t>(size - 1));
  for (int rank = 1; rank < size; ++rank)
    shared_->threads.emplace_back([shared = shared_.get(), rank] { work(*shared, rank); });
}

Pool::~Pool() {
  if (forked()) {
    // Do not destroy it: the destructor of a condition variable waits for sleeping threads, and here they never wake.
    static_cast<void>(shared_.release());
    return;
  }
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = true;
  }
  shared_->wake.notify_all();
  for (std::thread& thread : shared_->threads) thread.join();
}

bool Pool::forked() const { return getpid() != process_; }

void Pool::run(const std::function<void(int)>& job) {
  Shared& shared = *shared_;
  {
    const std::lock_guard lock(shared.mutex);
    shared.job = &job;
    shared.busy = size_ - 1;
    ++shared.round;
  }
  shared.wake.notify_all();
  job(0);
  std::unique_lock lock(shared.mutex);
  shared.done.wait(lock, [&] { return shared.busy == 0; });
}

void Pool::work(Shared& shared, int rank) {
  const FloatMode mode(shared.flush);
  uint64_t seen = 0;
  for (;;) {
    const std::function<void(int)>* job;
    {
      std::unique_lock lock(shared.mutex);
      shared.wake.wait(lock, [&] { return shared.stop || shared.round != seen; });
      if (shared.stop) return;
      seen = shared.round;
      job = shared.job;
    }
    (*job)(rank);
    {
      const std::lock_guard lock(shared.mutex);
      if (--shared.busy == 0) shared.done.notify_one();
    }
  }
}

}  // namespace hedon

#endif
