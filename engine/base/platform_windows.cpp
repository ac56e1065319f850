/// The platform for processes on Windows.
#if defined(_WIN32)

#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>

#include <process.h>

#include <bit>
#include <cerrno>
#include <utility>

#include "base/platform.h"

namespace hedon {

// Windows counts all of it against memory and its page file, including pages that are never touched.
void* reserve_pages(size_t bytes) { return VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE); }

void release_pages(void* block, size_t) { VirtualFree(block, 0, MEM_RELEASE); }

int64_t physical_memory() {
  MEMORYSTATUSEX status = {};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) != 0 ? static_cast<int64_t>(status.ullTotalPhys) : 0;
}

// The page file already does that for all memory.
int64_t back_with_file(void*, size_t, const char*) { return -ENOTSUP; }

void expect_in_file(const void*, size_t) {}

void forget_in_file(int64_t, int64_t, int64_t) {}

void close_file(int64_t) {}

/// The processors in the group of the process: at most 64.
int available_processors() {
  DWORD_PTR mine = 0, present = 0;
  GetProcessAffinityMask(GetCurrentProcess(), &mine, &present);
  return mine != 0 ? std::popcount(static_cast<uint64_t>(mine)) : 1;
}

int64_t current_process() { return GetCurrentProcessId(); }

struct Thread::Handle {
  HANDLE thread;
  std::function<void()> work;
};

Thread::Thread(std::function<void()> work) : handle_(std::make_unique<Handle>(Handle{nullptr, std::move(work)})) {
  const auto call = [](void* handle) -> unsigned {
    static_cast<Handle*>(handle)->work();
    return 0;
  };
  const uintptr_t thread = _beginthreadex(nullptr, 0, call, handle_.get(), 0, nullptr);
  handle_->thread = reinterpret_cast<HANDLE>(thread);
  if (thread == 0) handle_.reset();
}

Thread::~Thread() {
  if (!begun()) return;
  WaitForSingleObject(handle_->thread, INFINITE);
  CloseHandle(handle_->thread);
}

void sleep_while(const std::atomic<uint32_t>& word, uint32_t value) {
  volatile void* const address = const_cast<std::atomic<uint32_t>*>(&word);
  while (word.load(std::memory_order_acquire) == value) WaitOnAddress(address, &value, sizeof value, INFINITE);
}

void wake_all(std::atomic<uint32_t>& word) { WakeByAddressAll(&word); }

}  // namespace hedon

#endif
