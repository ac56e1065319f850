/// The packed observation: the input of a network, without the many entries that are always the same.
///
/// A ray has at most one channel that is not -1, and touch is mostly 0. With x' = x + 1 for the rays, the -1 becomes a
/// part of the bias of the first layer (exact algebra). The layer is then one row-addition per ray instead of one per
/// channel. `unpack` gives the full observation, in the order of docs/model.md, section 5.
#pragma once

#include <cstdint>

#include "base/device.h"

namespace hedon {

inline constexpr int PACKED_RAYS = 32;
inline constexpr int MAX_DENSE = 6;

/// One observation: 192 bytes, three cache lines.
struct alignas(64) PackedObservation {
  float ray[PACKED_RAYS];         ///< reading + 1 of the channel that the ray hit, in [1, 2]; 0 if it hit nothing
  uint8_t ray_type[PACKED_RAYS];  ///< that channel; 0 if the ray hit nothing
  uint64_t touch;                 ///< bit type * sectors + sector
  float dense[MAX_DENSE];         ///< velocity (2), heading (1, or sine and cosine), angular velocity, energy
};
static_assert(sizeof(PackedObservation) == 192);

/// Sizes of the observation. Its entries, and the rows of the first layer: rays (type, ray), touch (type, sector),
/// dense.
struct ObservationShape {
  int32_t rays;
  int32_t types;
  int32_t touches;  ///< types * sectors, at most 64
  int32_t dense;    ///< 5 or 6

  HEDON_INLINE int32_t ray_entries() const { return types * rays; }
  HEDON_INLINE int32_t size() const { return ray_entries() + touches + dense; }

  /// The row of a ray and a type. Neighboring rays mostly hit the same type, so their rows are next to one another.
  HEDON_INLINE int32_t ray_entry(int32_t ray, int32_t type) const { return type * rays + ray; }
};

/// Writes the full observation: `size()` floats.
HEDON_FN void unpack(const ObservationShape& shape, const PackedObservation& packed, float* full) {
  int32_t at = shape.ray_entries();
  for (int32_t i = 0; i < at; ++i) full[i] = -1.0f;
  for (int32_t r = 0; r < shape.rays; ++r) full[shape.ray_entry(r, packed.ray_type[r])] = packed.ray[r] - 1.0f;
  for (int32_t t = 0; t < shape.touches; ++t, ++at) full[at] = static_cast<float>((packed.touch >> t) & 1u);
  for (int32_t d = 0; d < shape.dense; ++d, ++at) full[at] = packed.dense[d];
}

}  // namespace hedon
