/// An error that the caller can fix: `hedon.error.EngineError` in Python.
#pragma once

#include <stdexcept>

namespace hedon {

class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hedon
