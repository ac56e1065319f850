/// A batch of a step. Finds its contacts, reports them to the visitor and fills them in for the solver.
#pragma once

#include <cstdint>

#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

/// The indices and pairs of one batch.
struct BatchRange {
  int32_t first_index, last_index;
  int32_t first_body_pair, last_body_pair;
  int32_t first_circle_pair, last_circle_pair;
  int32_t first_wall_pair, last_wall_pair;
};

HEDON_FN BatchRange batch_range(const NeighborList& list, int32_t batch) {
  const NeighborHead& head = list.head[0];
  const int32_t first = head.batch_start[batch], last = head.batch_start[batch + 1];
  return {first,
          last,
          list.bodies.start[first],
          list.bodies.start[last],
          list.circles.start[first],
          list.circles.start[last],
          list.walls.start[first],
          list.walls.start[last]};
}

/// The input of a solver: one batch in one step.
struct Batch {
  const PhysicsConfig& config;
  const BodyShape& shape;
  const SolverConstants& c;
  const PhysicsState& state;
  const PhysicsScratch& scratch;
  BatchRange range;

  /// Distances at which two centers, or a center and a wall, just touch [u].
  HEDON_FN float body_touch() const { return 2.0f * shape.radius; }
  HEDON_FN float circle_touch() const { return shape.radius + shape.circle_radius; }
  HEDON_FN float wall_touch() const { return shape.radius; }

  /// The contacts of the batch. Those with circles and then those with walls share an array.
  HEDON_FN BodyContact* body_contacts() const { return scratch.body_contacts.data + range.first_body_pair; }
  HEDON_FN StaticContact* static_contacts() const {
    return scratch.static_contacts.data + range.first_circle_pair + range.first_wall_pair;
  }
};

/// Squared distances below which two things touch, and below which the solver acts on them [u²].
struct Reach {
  float touch, solid;
};

/// Unit vector and distance from one point to another; for equal points, by convention, the vector points along y.
struct Direction {
  float x, y, distance;
};

HEDON_FN Direction direction_of(Vec2 between) {
  const float squared = squared_length(between);
  if (!(squared > 0.0f)) return {0.0f, 1.0f, 0.0f};
  const float distance = sqrtf(squared);
  const float inverse = 1.0f / distance;
  return {between.x * inverse, between.y * inverse, distance};
}

/// Counts, and whether any contact approaches so fast that it may bounce.
struct FoundContacts {
  int32_t count;
  bool fast;
};

/// Reports two bodies that touch to the visitor, once for each.
template <class Visitor>
HEDON_FN void tell_bodies(const Batch& batch, int32_t pair, Vec2 normal, Visitor& visitor) {
  const NeighborList& list = batch.state.neighbors;
  const int32_t first = list.bodies.first[pair], second = list.bodies.second[pair];
  const int32_t a = list.slot[first], b = list.slot[second];
  visitor.on_contact(PairKind::body, a, b, normal, batch.scratch.angle[first], list.bodies.mark[pair]);
  visitor.on_contact(PairKind::body, b, a, -normal, batch.scratch.angle[second], list.bodies.mark[pair]);
}

/// Fills in the contact of a pair of bodies, with the stored impulses of the pair.
HEDON_FN void fill_contact(const Batch& batch, int32_t pair, const Direction& normal, BodyContact& contact) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PhysicsScratch& scratch = batch.scratch;
  contact.first = pairs.first[pair];
  contact.second = pairs.second[pair];
  contact.normal_x = normal.x;
  contact.normal_y = normal.y;
  contact.arm = 0.5f * normal.distance;
  contact.turn = contact.arm * batch.c.inverse_gyration;
  contact.tangent_mass = 0.5f / (1.0f + contact.arm * contact.turn);
  contact.normal_impulse = scratch.bodies.normal[pair];
  contact.tangent_impulse = scratch.bodies.tangent[pair];
  contact.approach = relative_velocity(contact, scratch.motion[contact.first], scratch.motion[contact.second]).normal;
  contact.pair = pair;
}

/// Fills in the contact of a body with a static object, whose nearest point is `point`. The centers, or center and
/// wall, just touch at a distance of `touch` [u].
HEDON_FN void fill_contact(const Batch& batch, const PairList& pairs, const PairScratch& work, int32_t pair, Vec2 point,
                           const Direction& normal, float touch, StaticContact& contact) {
  contact.body = pairs.first[pair];
  contact.anchor_x = point.x - touch * normal.x;
  contact.anchor_y = point.y - touch * normal.y;
  contact.normal_x = normal.x;
  contact.normal_y = normal.y;
  contact.arm = batch.shape.radius + 0.5f * (normal.distance - touch);
  contact.turn = contact.arm * batch.c.inverse_gyration;
  contact.tangent_mass = 1.0f / (1.0f + contact.arm * contact.turn);
  contact.normal_impulse = work.normal[pair];
  contact.tangent_impulse = work.tangent[pair];
  contact.approach = relative_velocity(contact, batch.scratch.motion[contact.body]).normal;
  contact.pair = pair;
}

/// Finds the contacts of a batch with circles or walls. A pair that the solver does not act on loses its impulses.
/// nearest(other, center)   the relevant point of the circle or wall
/// touch                    distance at which they just touch [u]
/// reach                    squared distances below which they touch, and below which the solver acts on them [u²]
template <class Visitor, class Nearest>
HEDON_FN FoundContacts find_static_contacts(PairKind kind, const Batch& batch, const PairList& pairs,
                                            const PairScratch& work, int32_t first_pair, int32_t last_pair, float touch,
                                            Reach reach, StaticContact* contacts, Visitor& visitor, Nearest&& nearest) {
  const PhysicsScratch& scratch = batch.scratch;
  const Vec2* position = scratch.position.data;
  int32_t count = 0;
  bool fast = false;
  for (int32_t pair = first_pair; pair < last_pair; ++pair) {
    const int32_t body = pairs.first[pair], other = pairs.second[pair];
    const Vec2 point = nearest(other, position[body]);
    const Vec2 between = point - position[body];
    const float squared = squared_length(between);
    if (!(squared < reach.solid)) {
      work.normal[pair] = 0.0f;
      work.tangent[pair] = 0.0f;
      if (!(squared < reach.touch)) continue;
    }
    const Direction normal = direction_of(between);
    if (squared < reach.solid) {
      StaticContact& contact = contacts[count++];
      fill_contact(batch, pairs, work, pair, point, normal, touch, contact);
      fast |= contact.approach <= -batch.c.restitution_threshold;
    }
    visitor.on_contact(kind, batch.state.neighbors.slot[body], other, Vec2{normal.x, normal.y}, scratch.angle[body],
                       pairs.mark[pair]);
  }
  return {count, fast};
}

/// Finds the contacts of a batch with circles.
template <class Visitor>
HEDON_FN FoundContacts find_circle_contacts(const Batch& batch, Reach reach, StaticContact* contacts,
                                            Visitor& visitor) {
  const StaticCircles& circles = batch.state.circles;
  const auto center = [&](int32_t circle, Vec2) { return Vec2{circles.x[circle], circles.y[circle]}; };
  return find_static_contacts(PairKind::circle, batch, batch.state.neighbors.circles, batch.scratch.circles,
                              batch.range.first_circle_pair, batch.range.last_circle_pair, batch.circle_touch(), reach,
                              contacts, visitor, center);
}

/// Finds the contacts of a batch with walls. `nearest(wall, center)` gives the relevant point of the wall.
template <class Visitor, class Nearest>
HEDON_FN FoundContacts find_wall_contacts(const Batch& batch, Reach reach, StaticContact* contacts, Visitor& visitor,
                                          Nearest&& nearest) {
  return find_static_contacts(PairKind::wall, batch, batch.state.neighbors.walls, batch.scratch.walls,
                              batch.range.first_wall_pair, batch.range.last_wall_pair, batch.wall_touch(), reach,
                              contacts, visitor, nearest);
}

}  // namespace hedon
