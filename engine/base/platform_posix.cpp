/// The platform for processes on Linux, macOS and other kinds of Unix.
#if !defined(__wasm__) && !defined(_WIN32)

#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined(__linux__)
#include <sched.h>
#endif

#include <cerrno>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>

#include "base/platform.h"

namespace hedon {

void* reserve_pages(size_t bytes) {
  void* block = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (block == MAP_FAILED) return nullptr;
#if defined(MADV_HUGEPAGE)
  madvise(block, bytes, MADV_HUGEPAGE);  // a hint: without it, everything works, but slower
#endif
  return block;
}

void release_pages(void* block, size_t bytes) { munmap(block, bytes); }

namespace {

/// Gives a file its length, and reserves its space on the disk. Returns 0, or the error number.
int make_room(int file, off_t bytes) {
#if defined(__APPLE__)
  fstore_t room = {F_ALLOCATEALL, F_PEOFPOSMODE, 0, bytes, 0};
  if (fcntl(file, F_PREALLOCATE, &room) != 0 || ftruncate(file, bytes) != 0) return errno;
  return 0;
#else
  return posix_fallocate(file, 0, bytes);
#endif
}

}  // namespace

int64_t back_with_file(void* first, size_t bytes, const char* folder) {
  std::string name = std::string(folder) + "/hedon-XXXXXX";
  const int file = mkstemp(name.data());
  if (file < 0) return -errno;
  unlink(name.c_str());
  int problem = make_room(file, static_cast<off_t>(bytes));
  if (problem == 0 && mmap(first, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, file, 0) == MAP_FAILED)
    problem = errno;
  if (problem != 0) {
    close(file);
    return -problem;
  }
#if defined(MADV_RANDOM)
  madvise(first, bytes, MADV_RANDOM);  // a step writes a little in many places, so their neighbors need not be fetched
#endif
  return file;
}

void expect_in_file([[maybe_unused]] const void* first, [[maybe_unused]] size_t bytes) {
#if defined(MADV_WILLNEED)
  const uintptr_t page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE)), from = reinterpret_cast<uintptr_t>(first);
  madvise(reinterpret_cast<void*>(from / page * page), bytes + from % page, MADV_WILLNEED);
#endif
}

void forget_in_file([[maybe_unused]] int64_t file, [[maybe_unused]] int64_t first, [[maybe_unused]] int64_t bytes) {
#if defined(FALLOC_FL_ZERO_RANGE)
  // Keeps the space on the disk. On file systems without support, pages are read before they are written.
  fallocate(static_cast<int>(file), FALLOC_FL_ZERO_RANGE, first, bytes);
#endif
}

void close_file(int64_t file) { close(static_cast<int>(file)); }

int64_t physical_memory() {
  return static_cast<int64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<int64_t>(sysconf(_SC_PAGESIZE));
}

int available_processors() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  const unsigned count = std::thread::hardware_concurrency();
  return count > 0 ? static_cast<int>(count) : 1;
}

int64_t current_process() { return getpid(); }

struct Thread::Handle {
  pthread_t thread;
  std::function<void()> work;
};

// Not std::thread, which throws if the system refuses a thread, while the engine is built without exceptions.
Thread::Thread(std::function<void()> work) : handle_(std::make_unique<Handle>(Handle{{}, std::move(work)})) {
  const auto call = [](void* handle) -> void* {
    static_cast<Handle*>(handle)->work();
    return nullptr;
  };
  if (pthread_create(&handle_->thread, nullptr, call, handle_.get()) != 0) handle_.reset();
}

Thread::~Thread() {
  if (begun()) pthread_join(handle_->thread, nullptr);
}

void sleep_while(const std::atomic<uint32_t>& word, uint32_t value) { word.wait(value, std::memory_order_acquire); }

void wake_all(std::atomic<uint32_t>& word) { word.notify_all(); }

}  // namespace hedon

#endif
