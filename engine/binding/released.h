/// The interpreter lock, released while the engine works.
#pragma once

#include <Python.h>

namespace hedon {

/// Releases the lock of the interpreter, and takes it again at the end of its scope. If the interpreter has ended by
/// then, as it can for a daemon thread, the thread stops there for good: it may never enter the interpreter again.
/// (nanobind's own guard would end the whole process: Python ends such a thread by unwinding it.) What it works on then
/// stays, and nanobind is told not to complain of that.
class Released {
 public:
  Released();
  ~Released();
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  PyThreadState* state_;
};

}  // namespace hedon
