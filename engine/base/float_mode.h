/// How a thread computes with floats: set while the engine works, and restored for the caller afterwards.
#pragma once

#include <cstdint>

namespace hedon {

/// While it exists: rounds to nearest, masks all exceptions and flushes denormals to zero. Then restores the thread's
/// mode. Other libraries change these modes, and denormal numbers are slow on many processors. Each entry into the
/// engine and each of its threads makes one, so that the bits of a seed do not depend on the caller.
///
/// ARM flushes a result that is below the smallest normal number before rounding, x86 one that still is after rounding.
/// So x86 gives ±2^-126 and ARM ±0 if a product, a fused one, or a double converted to a float is within 2^-151 below
/// it. Sums, quotients and roots cannot be there. No bit of a life depends on it: lives are the same without flushing.
class FloatMode {
 public:
  /// flush  false: keep denormals, as on processors that cannot flush them
  explicit FloatMode(bool flush = true) : saved_(read()) { write(flush ? FLUSH : KEEP); }
  ~FloatMode() { write(saved_); }

 private:
#if defined(__SSE__)
  using Register = unsigned;
  static constexpr Register KEEP = 0x1f80;          ///< all exceptions masked, to nearest
  static constexpr Register FLUSH = KEEP | 0x8040;  ///< flush results to zero, read denormals as zero
  static Register read() { return __builtin_ia32_stmxcsr(); }
  static void write(Register mode) { __builtin_ia32_ldmxcsr(mode); }
#elif defined(__aarch64__)
  using Register = uint64_t;
  static constexpr Register KEEP = 0;                   ///< no exception traps, to nearest, NaNs keep their payload
  static constexpr Register FLUSH = Register{1} << 24;  ///< FZ: flush results to zero, read denormals as zero
  static Register read() {
    Register mode;
    asm volatile("mrs %0, fpcr" : "=r"(mode)::"memory");
    return mode;
  }
  static void write(Register mode) { asm volatile("msr fpcr, %0" ::"r"(mode) : "memory"); }
#else
  using Register = int;
  static constexpr Register KEEP = 0, FLUSH = 0;
  static Register read() { return 0; }
  static void write(Register) {}
#endif
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

  Register saved_;
};

}  // namespace hedon
