#include "binding/checkpoint.h"

#include <nanobind/ndarray.h>

#include <cstring>
#include <string>
#include <utility>

namespace nb = nanobind;

namespace hedon {
namespace {

using Code = nb::dlpack::dtype_code;
constexpr Code CODES[] = {Code::Int, Code::UInt, Code::Float};  // in the order of NumberKind

using AnyArray = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;

NumberKind kind_of(const nb::dlpack::dtype& type, const std::string& name) {
  for (int kind = 0; kind < 3; ++kind) {
    if (type.code == static_cast<uint8_t>(CODES[kind]) && type.lanes == 1) return static_cast<NumberKind>(kind);
  }
  throw nb::value_error((name + " does not hold plain numbers").c_str());
}

}  // namespace

nb::dict to_arrays(Checkpoint checkpoint) {
  nb::dict out;
  for (SavedArray& array : checkpoint) {
    auto* held = new SavedArray(std::move(array));
    const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<SavedArray*>(p); });
    const std::vector<size_t> shape(held->shape.begin(), held->shape.end());
    const nb::dlpack::dtype type{static_cast<uint8_t>(CODES[static_cast<int>(held->kind)]),
                                 static_cast<uint8_t>(8 * held->size), 1};
    const nb::ndarray<nb::numpy> view(held->bytes.data(), shape.size(), shape.data(), owner, nullptr, type);
    out[held->name.c_str()] = nb::cast(view);
  }
  return out;
}

Checkpoint from_arrays(const nb::dict& arrays) {
  Checkpoint out;
  for (const auto& [key, value] : arrays) {
    const std::string name = nb::str(key).c_str();
    AnyArray array;
    if (!nb::try_cast(value, array)) throw nb::value_error((name + " is not an array of numbers in C order").c_str());
    SavedArray saved{name, kind_of(array.dtype(), name), array.dtype().bits / 8, {}, {}};
    for (size_t d = 0; d < array.ndim(); ++d) saved.shape.push_back(static_cast<int64_t>(array.shape(d)));
    saved.bytes.resize(array.nbytes());
    if (!saved.bytes.empty()) memcpy(saved.bytes.data(), array.data(), saved.bytes.size());
    out.push_back(std::move(saved));
  }
  return out;
}

}  // namespace hedon
