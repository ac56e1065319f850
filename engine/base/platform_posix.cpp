/// The system that a process of Linux, macOS or another kind of Unix has.
#if !defined(__wasm__) && !defined(_WIN32)

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined(__linux__)
#include <sched.h>
#endif

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

// Not std::thread, which throws where the system gives no thread: the engine is built without exceptions.
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
