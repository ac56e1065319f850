/// Chooses among the kernels that this processor can run.
#include "kernel/kernel.h"

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
    __builtin_cpu_init();
    const bool has_fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (has_fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
      add(AVX512_KERNEL);
    }
    if (has_fma) add(AVX2_KERNEL);
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
