#include "base/parallel.h"

#include <deque>

#include "base/float_mode.h"

namespace hedon {

/// The data on which the threads wait. The job and the stop flag are written before the round that they wait for.
struct Pool::Shared {
  std::atomic<uint32_t> round{0};
  std::atomic<uint32_t> busy{0};
  const std::function<void(int)>* job = nullptr;
  bool stop = false;
  bool flush;
  std::deque<Thread> threads;

  ~Shared() {
    stop = true;
    begin_round();
    threads.clear();
  }

  void begin_round() {
    round.fetch_add(1);
    wake_all(round);
  }
};

Pool::Pool(int size, bool flush) : size_(size), process_(current_process()), shared_(std::make_unique<Shared>()) {
  shared_->flush = flush;
  for (int rank = 1; rank < size; ++rank) {
    shared_->threads.emplace_back([shared = shared_.get(), rank] { work(*shared, rank); });
    if (!shared_->threads.back().begun()) return;
  }
}

bool Pool::whole() const { return size_ == 1 || shared_->threads.back().begun(); }

Pool::~Pool() {
  if (forked()) static_cast<void>(shared_.release());  // its threads do not exist here and cannot be joined
}

bool Pool::forked() const { return current_process() != process_; }

void Pool::run(const std::function<void(int)>& job) {
  Shared& shared = *shared_;
  shared.job = &job;
  shared.busy.store(static_cast<uint32_t>(size_ - 1));
  shared.begin_round();
  job(0);
  while (const uint32_t busy = shared.busy.load()) sleep_while(shared.busy, busy);
}

void Pool::work(Shared& shared, int rank) {
  const FloatMode mode(shared.flush);
  for (uint32_t seen = 0;; ++seen) {
    sleep_while(shared.round, seen);
    if (shared.stop) return;
    (*shared.job)(rank);
    if (shared.busy.fetch_sub(1) == 1) wake_all(shared.busy);
  }
}

}  // namespace hedon
