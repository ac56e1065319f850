/// The interpreter lock, released while the engine works.
#pragma once

#include <Python.h>

namespace hedon {

/// Releases the lock of the interpreter, and takes it again at the end of its scope. If the interpreter has ended by
/// then, as can happen to a daemon thread, the thread stops there for good, since it may never enter the interpreter
/// again. (nanobind's own guard would end the whole process, because Python ends such a thread by unwinding it.) The
/// objects in use are then leaked, and nanobind's warning about them is disabled.
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
