#include "simulation/pack.h"

#include <cstring>

#include "base/hash.h"

namespace hedon {
namespace {

constexpr uint64_t MOST_DIMENSIONS = 2;

/// Takes parts from the front of a string; false if it is too short.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  bool empty() const { return left_.empty(); }
  bool number(uint64_t& out) {
    std::string_view part;
    if (!take(sizeof out, part)) return false;
    memcpy(&out, part.data(), sizeof out);
    return true;
  }
  /// Includes the padding to eight bytes.
  bool padded(uint64_t bytes, std::string_view& out) {
    std::string_view rest;
    return take(bytes, out) && take((8 - bytes % 8) % 8, rest);
  }
  bool text(std::string_view& out) {
    uint64_t bytes = 0;
    return number(bytes) && padded(bytes, out);
  }

 private:
  bool take(uint64_t bytes, std::string_view& out) {
    if (bytes > left_.size()) return false;
    out = left_.substr(0, bytes);
    left_.remove_prefix(bytes);
    return true;
  }

  std::string_view left_;
};

/// The rest of an array after its name.
bool read_array(Reader& in, SavedArray& array) {
  uint64_t kind = 0, size = 0, dimensions = 0;
  if (!in.number(kind) || !in.number(size) || !in.number(dimensions)) return false;
  if (kind > static_cast<uint64_t>(NumberKind::real) || size == 0 || size > 8 || dimensions > MOST_DIMENSIONS)
    return false;
  array.kind = static_cast<NumberKind>(kind);
  array.size = static_cast<int32_t>(size);
  uint64_t bytes = size;
  for (uint64_t d = 0; d < dimensions; ++d) {
    uint64_t length = 0;
    if (!in.number(length) || length > INT32_MAX || bytes > UINT32_MAX) return false;
    bytes *= length;
    array.shape.push_back(static_cast<int64_t>(length));
  }
  std::string_view all;
  if (!in.padded(bytes, all)) return false;
  array.bytes = {all.data(), all.size()};
  return true;
}

bool read_world(Reader& in, SavedWorld& world) {
  std::string_view slots;
  if (!in.number(world.seed) || !in.text(slots)) return false;
  world.slots = {slots.data(), slots.size()};
  for (std::string_view name; in.text(name);) {
    if (name.empty()) return true;
    SavedArray array{{std::string(name), NumberKind::integer, 0, {}}, {}, nullptr};
    if (!read_array(in, array)) return false;
    world.arrays.push_back(std::move(array));
  }
  return false;
}

}  // namespace

Packed unpack(std::string_view bytes, bool hashed) {
  Packed out;
  const std::string_view mark(PACK_MARK, sizeof PACK_MARK);
  if (bytes.substr(0, mark.size()) != mark) {
    out.complaint = "are no worlds that were saved";
    return out;
  }
  out.complaint = "are damaged";
  Reader in(bytes.substr(mark.size()));
  uint64_t hash = 0, worlds = 0;
  if (!in.number(hash)) return out;
  const std::string_view rest = bytes.substr(mark.size() + sizeof hash);
  if ((hashed && hash != hash_bytes(rest.data(), rest.size())) || !in.text(out.head) || !in.number(worlds)) return out;
  for (uint64_t w = 0; w < worlds; ++w) {
    out.worlds.emplace_back();
    if (!read_world(in, out.worlds.back())) return out;
  }
  if (in.empty()) out.complaint.clear();
  return out;
}

}  // namespace hedon
