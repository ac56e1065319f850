/// A small pool of threads that all run one function: the members of a simulation's teams.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace hedon {

/// Number of processors that this process may use.
int available_processors();

/// Threads that sleep until `run`, in which the caller works too. Joined in the destructor.
class Pool {
 public:
  explicit Pool(int size);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// True in a process that was forked from the pool's own: its threads do not exist there.
  bool forked() const;

  /// Calls job(rank) once for each rank in [0, size), rank 0 on the calling thread; returns when all are done.
  void run(const std::function<void(int)>& job);

 private:
  void work(int rank);

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(int)>* job_ = nullptr;
  uint64_t round_ = 0;
  int busy_ = 0;
  bool stop_ = false;
  int64_t process_;
};

}  // namespace hedon
