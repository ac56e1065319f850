/// One block of memory per world; the lists of fields give its layout.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <utility>

#include "base/array.h"
#include "base/platform.h"
#include "world/shape.h"
#include "world/state.h"
#include "world/world.h"

namespace hedon {

template <class T>
struct IsArray : std::false_type {};
template <class T>
struct IsArray<Array<T>> : std::true_type {};

/// Calls visit(path, array) for every array in a struct of fields, in order, through nested structs.
template <class Struct, class Visit>
void for_each_array(Struct& fields, const std::string& prefix, Visit&& visit) {
  std::remove_const_t<Struct>::for_each_field([&](const char* name, auto member) {
    auto& field = fields.*member;
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (IsArray<Field>::value) {
      visit(prefix + name, field);
    } else if constexpr (std::is_class_v<Field>) {
      for_each_array(field, prefix + name + ".", visit);
    }
  });
}

/// Zeroed memory. Pages that are never touched use no memory. Large pages are requested, because a step reads weights
/// from the whole block of a world, and with small pages address translation would take longer than reading.
class Memory {
 public:
  static constexpr int64_t ALIGNMENT = 64;  ///< of each array: a cache line, and 16 floats
#if defined(__wasm__)
  static constexpr int64_t PAGE = ALIGNMENT;  ///< no pages to choose from, and all memory is committed
  static constexpr int64_t SMALL_PAGE = ALIGNMENT;
#else
  static constexpr int64_t PAGE = int64_t{1} << 21;        ///< a large page
  static constexpr int64_t SMALL_PAGE = int64_t{1} << 16;  ///< at least a page of any system
#endif

  Memory() = default;
  explicit Memory(int64_t bytes);
  ~Memory();
  Memory(Memory&& other) noexcept { swap(other); }
  Memory& operator=(Memory&& other) noexcept {
    swap(other);
    return *this;
  }

  char* data() const { return first_; }
  int64_t size() const { return size_; }

  /// Keeps everything from `first` on, a multiple of `SMALL_PAGE`, in a file in a folder instead. Nothing may have been
  /// written there yet. Returns 0, or the system's error number.
  int keep_in_file(int64_t first, const std::string& folder);

  /// Prefetches bytes that will soon be read, if they are in the file.
  void expect(const void* from, int64_t bytes) const {
    if (file_ >= 0 && from >= first_ + in_file_) expect_in_file(from, static_cast<size_t>(bytes));
  }

  /// Discards bytes, so that pages of the file with no others are not read before they are written again.
  void forget(const void* from, int64_t bytes);

 private:
  void swap(Memory& other) {
    std::swap(size_, other.size_);
    std::swap(block_, other.block_);
    std::swap(first_, other.first_);
    std::swap(in_file_, other.in_file_);
    std::swap(file_, other.file_);
  }

  int64_t size_ = 0;
  void* block_ = nullptr;
  char* first_ = nullptr;
  int64_t in_file_ = 0;  ///< start of the part that is in a file
  int64_t file_ = -1;    ///< -1: none
};

/// Size of an array, in whole cache lines [byte].
template <class T>
int64_t laid_out_bytes(const Array<T>& array) {
  // One spare line: vector loads may read, but never use, up to 15 floats past the end.
  const int64_t bytes = array.count * static_cast<int64_t>(sizeof(T)) + Memory::ALIGNMENT;
  return (bytes + Memory::ALIGNMENT - 1) / Memory::ALIGNMENT * Memory::ALIGNMENT;
}

/// Places arrays one after another from `at` on, each rounded up to whole cache lines; only counts bytes if it is null.
struct Placer {
  char* at;
  int64_t bytes = 0;

  template <class T>
  void operator()(const std::string&, Array<T>& array) {
    if (at != nullptr) array.data = reinterpret_cast<T*>(at + bytes);
    bytes += laid_out_bytes(array);
  }
};

/// Size of the arrays of `fields` [byte]; places them from `at` on unless it is null.
template <class Struct>
int64_t lay_out(Struct& fields, char* at) {
  Placer placer{at};
  for_each_array(fields, "", placer);
  return placer.bytes;
}

/// The same for those arrays of the state whose sizes are so.
template <class IsSo>
int64_t lay_out_some(WorldState& state, char* at, IsSo&& is_so) {
  Placer place{at};
  WorldState::for_each_shape([&](const char* name, auto member, ArrayShape size) {
    auto& field = state.*member;
    if (!is_so(size)) return;
    if constexpr (IsArray<std::remove_cvref_t<decltype(field)>>::value)
      place(name, field);
    else
      for_each_array(field, "", place);
  });
  return place.bytes;
}

/// Numbers of bodies, circles, walls and pairs that the physics of a world must have room for.
PhysicsCapacity world_physics_capacity(const World& world);

/// Sets the sizes of all arrays of a world, for teams of up to `members`.
void set_counts(World& world, int members);

}  // namespace hedon
