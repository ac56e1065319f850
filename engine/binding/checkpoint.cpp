#include "binding/checkpoint.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>
#include <string>
#include <utility>

#include "simulation/pack.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using Code = nb::dlpack::dtype_code;
using AnyArray = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;

constexpr Code CODES[] = {Code::Int, Code::UInt, Code::Float};  // in the order of NumberKind

NumberKind kind_of(const nb::dlpack::dtype& type, const std::string& name) {
  for (int kind = 0; kind < 3; ++kind) {
    if (type.code == static_cast<uint8_t>(CODES[kind]) && type.lanes == 1) return static_cast<NumberKind>(kind);
  }
  throw nb::value_error((name + " does not hold plain numbers").c_str());
}

/// A checkpoint whose numbers stay in the caller's memory.
struct GivenArrays {
  Checkpoint checkpoint;
  std::vector<AnyArray> held;  ///< keeps the memory alive
};

/// ValueError: something is not an array of plain numbers.
GivenArrays from_arrays(const nb::dict& arrays) {
  GivenArrays out;
  for (const auto& [key, value] : arrays) {
    const std::string name = nb::str(key).c_str();
    AnyArray array;
    if (!nb::try_cast(value, array)) throw nb::value_error((name + " is not an array of numbers in C order").c_str());
    SavedArray saved{{name, kind_of(array.dtype(), name), array.dtype().bits / 8, {}}, {}, nullptr};
    for (size_t d = 0; d < array.ndim(); ++d) saved.shape.push_back(static_cast<int64_t>(array.shape(d)));
    saved.bytes = {static_cast<const char*>(array.data()), array.nbytes()};
    out.checkpoint.push_back(std::move(saved));
    out.held.push_back(std::move(array));
  }
  return out;
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

void save_to(PythonSimulation& self, int world, const nb::callable& begin, const nb::callable& piece) {
  self.slotted(world);
  self.need_whole(world);
  std::exception_ptr raised;  // the engine is built without exceptions, so none may pass through it
  const auto guarded = [&](auto&& call) {
    try {
      call();
    } catch (...) {
      raised = std::current_exception();
    }
    return !raised;
  };
  const auto head = [&](const SavedHead& array) {
    constexpr const char* KINDS[] = {"i", "u", "f"};  // in the order of NumberKind
    const std::string type = KINDS[static_cast<int>(array.kind)] + std::to_string(array.size);
    return guarded([&] { begin(array.name, type, array.shape); });
  };
  const auto bytes = [&](std::span<const char> part) {
    return guarded([&] { piece(nb::bytes(part.data(), part.size())); });
  };
  self.get().save(world, {head, bytes});
  if (raised) std::rethrow_exception(raised);
}

void restore_from(PythonSimulation& self, int world, const nb::dict& arrays) {
  self.world(world);
  const GivenArrays given = from_arrays(arrays);
  const std::string complaint = self.get().restore(world, given.checkpoint);
  if (!complaint.empty()) throw nb::value_error(complaint.c_str());
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
