/// How a thread computes with floats: set for the engine while it works, and given back to the caller afterwards.
#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace hedon {

/// Rounds to nearest, masks all exceptions and flushes denormals to zero while it lives, then restores what the thread
/// had: other libraries change these, and denormal numbers are slow on many processors. Each entry into the engine and
/// each of its threads makes one, so that a seed's bits do not depend on the caller.
class FloatMode {
 public:
  /// flush  false keeps denormals, as on processors that cannot flush them
#if defined(__SSE__)
  explicit FloatMode(bool flush = true) : saved_(_mm_getcsr()) { _mm_setcsr(MASKED | (flush ? FLUSH : 0u)); }
  ~FloatMode() { _mm_setcsr(saved_); }

 private:
  static constexpr unsigned MASKED = 0x1f80;  ///< all exceptions masked, to nearest
  static constexpr unsigned FLUSH = 0x8040;   ///< flush results to zero, take denormals for zero
  unsigned saved_;
#else
  explicit FloatMode(bool = true) {}
  ~FloatMode() {}

 private:
#endif
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;
};

}  // namespace hedon
