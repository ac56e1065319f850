/// The scratch memory of a world's substeps in shared memory, as far as its bodies and pairs fit.
///
/// Substeps access little else than the motions of bodies, their contacts and impulses, and access each of them many
/// times. None of this is needed after the step, so nothing is copied back.
#pragma once

#include "cuda/variant.h"
#include "physics/state.h"

namespace hedon {

/// Hands out shared memory: to each array, room for the same number of bodies or pairs.
struct SharedMemory {
  float* next;
  int64_t room;

  /// Moves an array there if `count` elements fit into the room for elements of `size` bytes, a multiple of four.
  template <class T>
  HEDON_FN void take(Array<T>& array, int64_t count, size_t size = sizeof(T)) {
    const int64_t bytes = room * static_cast<int64_t>(size);
    if (count * static_cast<int64_t>(sizeof(T)) <= bytes) array.data = reinterpret_cast<T*>(next);
    next += bytes / static_cast<int64_t>(sizeof(float));
  }
};

/// Moves the arrays of substeps to shared memory, each if all bodies or pairs of the list fit.
/// room   bodies, pairs of bodies, or pairs with static objects that each array has room for
HEDON_FN void move_to_shared(PhysicsScratch& scratch, const NeighborList& list, float* memory, int64_t room) {
  const int32_t bodies = list.head[0].bodies;
  const int32_t body_pairs = list.bodies.start[bodies];
  const int32_t circle_pairs = list.circles.start[bodies], wall_pairs = list.walls.start[bodies];
  SharedMemory shared{memory, room};
  shared.take(scratch.motion, bodies);  // first, since it must be aligned to 16 bytes
  shared.take(scratch.position, bodies);
  shared.take(scratch.angle, bodies);
  shared.take(scratch.colors, bodies);
  shared.take(scratch.bodies.normal, body_pairs);
  shared.take(scratch.bodies.tangent, body_pairs);
  shared.take(scratch.circles.normal, circle_pairs);
  shared.take(scratch.circles.tangent, circle_pairs);
  shared.take(scratch.walls.normal, wall_pairs);
  shared.take(scratch.walls.tangent, wall_pairs);
  shared.take(scratch.static_contacts, circle_pairs + wall_pairs);
  if (scratch.body_contacts.count > 0)
    shared.take(scratch.body_contacts, body_pairs);
  else
    shared.take(scratch.mixed_contacts, body_pairs, sizeof(BodyContact));
}

/// Floats of shared memory for a copy of the scratch memory's pointers, and for the arrays; 0 if there is no room.
constexpr int64_t stage_floats(int64_t room) {
  constexpr size_t each = sizeof(Motion) + sizeof(Vec2) + sizeof(float) + sizeof(uint32_t) + 6 * sizeof(float) +
                          sizeof(StaticContact) + sizeof(BodyContact);
  const size_t bytes = sizeof(PhysicsScratch) + static_cast<size_t>(room) * each;
  return room == 0 ? 0 : static_cast<int64_t>(bytes / sizeof(float));
}

}  // namespace hedon
