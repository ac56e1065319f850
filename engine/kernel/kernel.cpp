/// Chooses among the kernels that this processor can run.
#include "kernel/kernel.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <cstring>

namespace hedon {

extern const Kernel PORTABLE_KERNEL;
#if defined(__x86_64__)
extern const Kernel AVX2_KERNEL;
extern const Kernel AVX512_KERNEL;
#elif defined(__aarch64__)
extern const Kernel NEON_KERNEL;
#endif

namespace {

constexpr int MAX_KERNELS = 3;

#if defined(__x86_64__)
/// The instruction sets of the processor whose registers the system saves. This is not `__builtin_cpu_supports`,
/// because some compilers' libraries lack the function that it calls. Source: Intel's manual, volume 1, sections 14.3
/// and 15.2.
struct Processor {
  bool avx2 = false;    ///< with fused multiply-add
  bool avx512 = false;  ///< F, DQ, BW, VL

  Processor() {
    constexpr unsigned FMA = 1u << 12, OSXSAVE = 1u << 27, AVX2 = 1u << 5;
    constexpr unsigned AVX512 = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31;
    constexpr unsigned YMM = 0x06, ZMM = 0xe6;  // bits of the registers that the system saves
    unsigned a, b, c, d, kept, upper;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & OSXSAVE) == 0 || (c & FMA) == 0) return;
    asm volatile("xgetbv" : "=a"(kept), "=d"(upper) : "c"(0));
    if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0) return;
    avx2 = (kept & YMM) == YMM && (b & AVX2) != 0;
    avx512 = avx2 && (kept & ZMM) == ZMM && (b & AVX512) == AVX512;
  }
};
#endif

/// The kernels that this processor can run, best first, and their names; both end with null.
struct KernelList {
  const Kernel* kernels[MAX_KERNELS + 1] = {};
  const char* names[MAX_KERNELS + 1] = {};
  int count = 0;

  void add(const Kernel& kernel) {
    kernels[count] = &kernel;
    names[count] = kernel.name;
    ++count;
  }

  KernelList() {
#if defined(__x86_64__)
    const Processor processor;
    if (processor.avx512) add(AVX512_KERNEL);
    if (processor.avx2) add(AVX2_KERNEL);
#elif defined(__aarch64__)
    add(NEON_KERNEL);
#endif
    add(PORTABLE_KERNEL);
  }
};

const KernelList& list() {
  static const KernelList kernels;
  return kernels;
}

}  // namespace

const Kernel* find_kernel(const char* name) {
  const KernelList& known = list();
  if (name[0] == '\0') return known.kernels[0];
  for (int i = 0; i < known.count; ++i) {
    if (strcmp(name, known.names[i]) == 0) return known.kernels[i];
  }
  return nullptr;
}

const char* const* kernel_names() { return list().names; }

}  // namespace hedon
