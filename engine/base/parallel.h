/// A small pool of threads that all run one function: the members of a simulation's teams.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "base/platform.h"

namespace hedon {

/// Threads that sleep until `run`; then the caller works too. The destructor joins them.
class Pool {
 public:
  /// flush  see `FloatMode`
  Pool(int size, bool flush);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int size() const { return size_; }

  /// Whether the system provided all threads; if not, nothing may run on the pool.
  bool whole() const;

  /// True in a process that was forked from the one that made the pool: its threads do not exist there.
  bool forked() const;

  /// Calls job(rank) once for each rank in [0, size), rank 0 on the calling thread; returns when all are done.
  void run(const std::function<void(int)>& job);

 private:
  struct Shared;
  static void work(Shared& shared, int rank);

  int size_;
  int64_t process_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace hedon
