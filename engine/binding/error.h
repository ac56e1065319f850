/// What the engine tells its caller to put right: `hedon.error.EngineError` in Python.
#pragma once

#include <stdexcept>

namespace hedon {

class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hedon
