/// Memory and checks shared by the bindings of the engine's parts.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <new>
#include <string>

#include "kernel/kernel.h"

namespace hedon {

/// Zeroed memory, aligned to 64 bytes.
template <class T>
class Aligned {
 public:
  explicit Aligned(size_t count)
      : data_(static_cast<T*>(::operator new(std::max<size_t>(count, 1) * sizeof(T), std::align_val_t{64}))) {
    std::memset(static_cast<void*>(data_), 0, std::max<size_t>(count, 1) * sizeof(T));
  }
  Aligned(const T* from, size_t count) : Aligned(count) {
    if (count > 0) std::memcpy(static_cast<void*>(data_), from, count * sizeof(T));
  }
  Aligned(Aligned&& from) noexcept : data_(from.data_) { from.data_ = nullptr; }
  ~Aligned() { ::operator delete(data_, std::align_val_t{64}); }
  T* get() const { return data_; }

 private:
  T* data_;
};

template <class T>
nanobind::ndarray<nanobind::numpy, T> to_numpy(const T* values, std::initializer_list<size_t> shape) {
  size_t count = 1;
  for (const size_t length : shape) count *= length;
  T* held = new T[std::max<size_t>(count, 1)];
  if (count > 0) std::memcpy(held, values, count * sizeof(T));
  nanobind::capsule owner(held, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  return nanobind::ndarray<nanobind::numpy, T>(held, shape, owner);
}

inline const Kernel& kernel_by_name(const std::string& name) {
  const Kernel* kernel = find_kernel(name.c_str());
  if (kernel == nullptr) throw nanobind::value_error(("kernel: unknown name '" + name + "'").c_str());
  return *kernel;
}

inline void check_length(size_t length, size_t expected, const char* name) {
  if (length != expected) {
    throw nanobind::value_error(
        (std::string(name) + ": length " + std::to_string(length) + ", expected " + std::to_string(expected)).c_str());
  }
}

}  // namespace hedon
