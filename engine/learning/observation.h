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
  float dense[MAX_DENSE];         ///< the first channels that the species observes
};
static_assert(sizeof(PackedObservation) == 192);

inline constexpr int MAX_EXTRA_DENSE = 14;

/// The additional part of a wide observation: a fourth cache line, directly after the packed observation.
struct alignas(64) ObservationExtra {
  uint64_t touch;                ///< bits from 64 on
  float dense[MAX_EXTRA_DENSE];  ///< entries from MAX_DENSE on
};
static_assert(sizeof(ObservationExtra) == 64);

/// A cache line of observations: arrays of observations are arrays of lines.
struct alignas(64) ObservationLine {
  uint8_t bytes[64];
};
inline constexpr int NARROW_LINES = sizeof(PackedObservation) / sizeof(ObservationLine);
inline constexpr int WIDE_LINES = NARROW_LINES + 1;

/// Only for observations of a wide layout.
HEDON_INLINE const ObservationExtra& extra_of(const PackedObservation& packed) {
  return *reinterpret_cast<const ObservationExtra*>(&packed + 1);
}
HEDON_INLINE ObservationExtra& extra_of(PackedObservation& packed) {
  return *reinterpret_cast<ObservationExtra*>(&packed + 1);
}

/// Sets dense entry `d`; entries from MAX_DENSE on exist only in a wide layout.
HEDON_INLINE void set_dense(PackedObservation& packed, int32_t d, float value) {
  if (d < MAX_DENSE)
    packed.dense[d] = value;
  else
    extra_of(packed).dense[d - MAX_DENSE] = value;
}

/// Sizes of the observation. Its entries, and the rows of the first layer: rays (type, ray), touch (type, sector),
/// dense.
struct ObservationShape {
  int32_t rays;
  int32_t types;
  int32_t touches;  ///< types * sectors, at most 128
  int32_t dense;    ///< at most MAX_DENSE + MAX_EXTRA_DENSE
  int32_t lines;    ///< cache lines from one observation to the next: NARROW_LINES, or WIDE_LINES

  HEDON_INLINE bool wide() const { return touches > 64 || dense > MAX_DENSE; }
  HEDON_INLINE int32_t narrow_dense() const { return dense < MAX_DENSE ? dense : MAX_DENSE; }
  constexpr HEDON_INLINE int32_t ray_entries() const { return types * rays; }
  constexpr HEDON_INLINE int32_t size() const { return ray_entries() + touches + dense; }

  /// The row of a ray and a type. Neighboring rays mostly hit the same type, so their rows are next to one another.
  HEDON_INLINE int32_t ray_entry(int32_t ray, int32_t type) const { return type * rays + ray; }
};

/// Observation `i` of an array.
HEDON_INLINE const PackedObservation* observation_at(const ObservationShape& shape, const PackedObservation* first,
                                                     int64_t i) {
  return reinterpret_cast<const PackedObservation*>(reinterpret_cast<const ObservationLine*>(first) + i * shape.lines);
}

/// Writes the full observation: `size()` floats.
HEDON_FN void unpack(const ObservationShape& shape, const PackedObservation& packed, float* full) {
  int32_t at = shape.ray_entries();
  for (int32_t i = 0; i < at; ++i) full[i] = -1.0f;
  for (int32_t r = 0; r < shape.rays; ++r) full[shape.ray_entry(r, packed.ray_type[r])] = packed.ray[r] - 1.0f;
  for (int32_t t = 0; t < shape.touches; ++t, ++at) {
    const uint64_t bits = t < 64 ? packed.touch : extra_of(packed).touch;
    full[at] = static_cast<float>((bits >> (t & 63)) & 1u);
  }
  for (int32_t d = 0; d < shape.dense; ++d, ++at)
    full[at] = d < MAX_DENSE ? packed.dense[d] : extra_of(packed).dense[d - MAX_DENSE];
}

}  // namespace hedon
