#include "binding/checkpoint.h"

#include <nanobind/ndarray.h>

#include <cstring>
#include <string>
#include <utility>

#include "simulation/pack.h"

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
    const nb::ndarray<nb::numpy> view(held->held.get(), shape.size(), shape.data(), owner, nullptr, type);
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
    SavedArray saved{name, kind_of(array.dtype(), name), array.dtype().bits / 8, {}, {}, nullptr};
    for (size_t d = 0; d < array.ndim(); ++d) saved.shape.push_back(static_cast<int64_t>(array.shape(d)));
    saved.held.reset(new char[array.nbytes()]);  // the array may be a copy that was made for this call
    saved.bytes = {saved.held.get(), array.nbytes()};
    if (array.nbytes() > 0) memcpy(saved.held.get(), array.data(), array.nbytes());
    out.push_back(std::move(saved));
  }
  return out;
}

nb::bytes pack(PythonSimulation& self, const nb::bytes& head) {
  for (int i = 0; i < self.get().world_count(); ++i) {
    self.slotted(i);
    self.need_whole(i);
  }
  const std::string_view text(head.c_str(), head.size());
  const size_t size = self.get().pack(text, nullptr);
  PyObject* const out = PyBytes_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(size));
  if (out == nullptr) throw nb::python_error();
  self.get().pack(text, PyBytes_AS_STRING(out));
  return nb::steal<nb::bytes>(out);
}

nb::bytes packed_head(const nb::bytes& bytes) {
  const Packed packed = unpack({bytes.c_str(), bytes.size()}, true);
  if (!packed.complaint.empty()) throw nb::value_error(packed.complaint.c_str());
  return nb::bytes(packed.head.data(), packed.head.size());
}

void unpack_into(PythonSimulation& self, const nb::bytes& bytes) {
  const std::string complaint = self.unpack({bytes.c_str(), bytes.size()});
  if (!complaint.empty()) throw nb::value_error(complaint.c_str());
}

}  // namespace hedon
