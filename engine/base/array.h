/// A view of a flat array: a pointer and its length. The memory belongs to the simulation.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

template <class T>
struct Array {
  T* data = nullptr;
  int64_t count = 0;

  HEDON_FN T& operator[](int64_t i) const { return data[i]; }
};

/// A short list inside a config struct: at most N items.
template <class T, int N>
struct FixedList {
  static constexpr int capacity = N;
  T items[N];
  int32_t count;

  HEDON_FN const T& operator[](int i) const { return items[i]; }
};

template <class T>
inline constexpr bool IS_FIXED_LIST = false;
template <class T, int N>
inline constexpr bool IS_FIXED_LIST<FixedList<T, N>> = true;

}  // namespace hedon
