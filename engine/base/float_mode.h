/// How a thread computes with floats: set while the engine works, and restored for the caller afterwards.
#pragma once

namespace hedon {

/// While it exists: rounds to nearest, masks all exceptions and flushes denormals to zero. Then restores the thread's
/// mode. Other libraries change these modes, and denormal numbers are slow on many processors. Each entry into the
/// engine and each of its threads makes one, so that the bits of a seed do not depend on the caller.
class FloatMode {
 public:
  /// flush  false: keep denormals, as on processors that cannot flush them
#if defined(__SSE__)
  explicit FloatMode(bool flush = true) : saved_(__builtin_ia32_stmxcsr()) {
    __builtin_ia32_ldmxcsr(MASKED | (flush ? FLUSH : 0u));
  }
  ~FloatMode() { __builtin_ia32_ldmxcsr(saved_); }

 private:
  static constexpr unsigned MASKED = 0x1f80;  ///< all exceptions masked, to nearest
  static constexpr unsigned FLUSH = 0x8040;   ///< flush results to zero, read denormals as zero
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
