/// All that the engine needs from a system beyond the standard library (which includes the clock): memory and threads.
/// There is one implementation for each kind of system: `platform_posix.cpp`, `platform_windows.cpp` and, for
/// WebAssembly in a page, `platform_web.cpp`. Everything else is the same on all systems.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace hedon {

/// Zeroed memory, in large pages if the system has them; null if it refuses. Pages that are never touched cost nothing
/// on systems that allow it.
void* reserve_pages(size_t bytes);

/// Releases memory from `reserve_pages`.
void release_pages(void* block, size_t bytes);

/// Backs pages from `reserve_pages` with a new file in a folder: when memory is short, the system writes unused pages
/// out, and reads them again later. The file has no name, reserves its space at once, and disappears when it is closed
/// or the process ends. Returns its descriptor, or the negative error number of the system.
int64_t back_with_file(void* first, size_t bytes, const char* folder);

/// Prefetches pages of such a file that will soon be read, all at once.
void expect_in_file(const void* first, size_t bytes);

/// Discards a part of such a file, which will be written before it is read again.
void forget_in_file(int64_t file, int64_t first, int64_t bytes);

/// Closes such a file, after its pages were released.
void close_file(int64_t file);

/// Memory of this machine [byte]; not known in a web page.
int64_t physical_memory();

/// Number of processors that this process may use; in a web page, the number of possible threads.
int available_processors();

/// Identifies this process: a forked one has another number.
int64_t current_process();

/// A thread that calls `work` once; empty if the system refuses another thread.
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

/// Sleeps until `word` differs from `value`. Change it with sequential consistency, and call `wake_all` afterwards.
void sleep_while(const std::atomic<uint32_t>& word, uint32_t value);

/// Wakes all threads that sleep on `word`.
void wake_all(std::atomic<uint32_t>& word);

}  // namespace hedon
