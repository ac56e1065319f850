/// All that the engine asks of a system besides the standard library, such as its clock: memory and threads. One file
/// answers for each kind of system: `platform_posix.cpp`, `platform_windows.cpp` and, for WebAssembly in a page,
/// `platform_web.cpp`. Everything else is the same everywhere.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace hedon {

/// Zeroed memory, in large pages where the system has them; null if it refuses. Pages that are never touched cost
/// nothing where the system allows that.
void* reserve_pages(size_t bytes);

/// Gives memory back that `reserve_pages` gave.
void release_pages(void* block, size_t bytes);

/// Puts a new file of a folder behind pages that `reserve_pages` gave: the system writes out what is not used where
/// memory is short, and reads it again. The file has no name, takes its room at once, and goes when it is closed or
/// the process ends. Returns its number, or minus the system's number of what went wrong.
int64_t back_with_file(void* first, size_t bytes, const char* folder);

/// Pages of such a file are soon read: all of them are fetched at once.
void expect_in_file(const void* first, size_t bytes);

/// What a part of such a file holds is needed no more: it is not read before it is written again.
void forget_in_file(int64_t file, int64_t first, int64_t bytes);

/// Closes such a file, after its pages were given back.
void close_file(int64_t file);

/// Memory of this machine [byte]. A page is not told.
int64_t physical_memory();

/// Number of processors that this process may use; in a page, of threads that there can be.
int available_processors();

/// Which process this is: a forked one has another number.
int64_t current_process();

/// A thread that calls `work` once; or none, if the system gives no more.
class Thread {
 public:
  explicit Thread(std::function<void()> work);
  /// Waits until `work` has returned.
  ~Thread();
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  /// Whether there is a thread.
  bool begun() const { return handle_ != nullptr; }

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

/// Sleeps until `word` holds something else than `value`. Who changes it must do so sequentially consistently, and
/// call `wake_all` after that.
void sleep_while(const std::atomic<uint32_t>& word, uint32_t value);

/// Wakes all who sleep on `word`.
void wake_all(std::atomic<uint32_t>& word);

}  // namespace hedon
