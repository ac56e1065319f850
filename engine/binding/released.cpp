#include "binding/released.h"

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace hedon {
namespace {

std::atomic<int> away{0};  ///< threads that have released the lock

}  // namespace

Released::Released() {
  if (away.fetch_add(1) == 0) nanobind::set_leak_warnings(false);
  state_ = PyEval_SaveThread();
}

Released::~Released() {
  try {
    PyEval_RestoreThread(state_);
  } catch (...) {  // pthread_exit unwinds
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
  if (away.fetch_sub(1) == 1) nanobind::set_leak_warnings(true);
}

}  // namespace hedon
