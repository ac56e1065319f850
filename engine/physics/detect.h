/// Which listed pairs overlap in this substep, and the contacts that the solver works on.
///
/// Contacts between bodies are put in the order of colors: no two of one color share a body, so that consecutive
/// contacts do not wait for one another. Only overlapping pairs take a color, in canonical order; the order of two
/// contacts that share a body thus depends on nothing but the contacts of their own cluster.
#pragma once

#include <bit>
#include <cstdint>

#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

inline constexpr int COLORS = 32;

/// The places and pairs of one batch.
struct BatchRange {
  int32_t first_place, last_place;
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

/// Unit vector and distance of two points; points that coincide are one above the other, by convention.
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

/// Counts, and whether a contact approaches so fast that it may bounce.
struct FoundContacts {
  int32_t count;
  bool fast;
};

/// Finds the contacts of a batch between bodies. A pair that is apart loses its impulses.
/// Contacts are written from `first_body_pair` on. The visitor hears of each contact twice, once for each body.
template <class Visitor>
HEDON_FN FoundContacts find_body_contacts(const NeighborList& list, const PhysicsScratch& scratch,
                                          const BatchRange& range, const SolverConstants& c, float radius,
                                          Visitor& visitor) {
  const PairList& pairs = list.bodies;
  const int32_t* first = pairs.first.data;
  const int32_t* second = pairs.second.data;
  float* normal_impulse = scratch.bodies.normal.data;
  float* tangent_impulse = scratch.bodies.tangent.data;
  const Vec2* position = scratch.position.data;
  const Motion* motion = scratch.motion.data;
  int32_t* active = scratch.active.data + range.first_body_pair;
  const float touch = 4.0f * radius * radius;
  int32_t count = 0;
  for (int32_t pair = range.first_body_pair; pair < range.last_body_pair; ++pair) {
    const bool touching = squared_length(position[second[pair]] - position[first[pair]]) < touch;
    active[count] = pair;
    count += touching;
    normal_impulse[pair] = touching ? normal_impulse[pair] : 0.0f;
    tangent_impulse[pair] = touching ? tangent_impulse[pair] : 0.0f;
  }
  if (count == 0) return {0, false};

  uint32_t* colors = scratch.colors.data;
  uint8_t* color = scratch.color.data + range.first_body_pair;
  for (int32_t place = range.first_place; place < range.last_place; ++place) colors[place] = 0;
  int32_t next[COLORS + 1] = {};
  for (int32_t i = 0; i < count; ++i) {
    uint32_t& a = colors[first[active[i]]];
    uint32_t& b = colors[second[active[i]]];
    // The last color takes all that is left over; its contacts may share bodies, which costs time only.
    const int taken = std::countr_zero(~(a | b) | 0x80000000u);
    a |= 1u << taken;
    b |= 1u << taken;
    color[i] = static_cast<uint8_t>(taken);
    ++next[taken + 1];
  }
  for (int taken = 0; taken < COLORS; ++taken) next[taken + 1] += next[taken];

  BodyContact* contacts = scratch.body_contacts.data + range.first_body_pair;
  bool fast = false;
  for (int32_t i = 0; i < count; ++i) {
    const int32_t pair = active[i];
    BodyContact& contact = contacts[next[color[i]]++];
    contact.first = first[pair];
    contact.second = second[pair];
    const Direction normal = direction_of(position[contact.second] - position[contact.first]);
    contact.normal_x = normal.x;
    contact.normal_y = normal.y;
    contact.arm = 0.5f * normal.distance;
    contact.turn = contact.arm * c.inverse_gyration;
    contact.tangent_mass = 0.5f / (1.0f + contact.arm * contact.turn);
    contact.normal_impulse = normal_impulse[pair];
    contact.tangent_impulse = tangent_impulse[pair];
    contact.approach = relative_velocity(contact, motion[contact.first], motion[contact.second]).normal;
    contact.pair = pair;
    fast |= contact.approach < -c.restitution_threshold;
    const int32_t a = list.slot[contact.first], b = list.slot[contact.second];
    visitor.on_contact(PairKind::body, a, b, Vec2{normal.x, normal.y}, scratch.angle[contact.first], pairs.mark[pair]);
    visitor.on_contact(PairKind::body, b, a, Vec2{-normal.x, -normal.y}, scratch.angle[contact.second],
                       pairs.mark[pair]);
  }
  return {count, fast};
}

/// Finds the contacts of a batch with circles or walls. `nearest(other, center)` is the other's point that counts,
/// `touch` the distance below which they overlap [u].
template <class Visitor, class Nearest>
HEDON_FN FoundContacts find_static_contacts(PairKind kind, const NeighborList& list, const PairList& pairs,
                                            const PairScratch& work, const PhysicsScratch& scratch, int32_t first_pair,
                                            int32_t last_pair, const SolverConstants& c, float radius, float touch,
                                            StaticContact* contacts, Visitor& visitor, Nearest&& nearest) {
  const Vec2* position = scratch.position.data;
  int32_t count = 0;
  bool fast = false;
  for (int32_t pair = first_pair; pair < last_pair; ++pair) {
    const int32_t body = pairs.first[pair], other = pairs.second[pair];
    const Vec2 point = nearest(other, position[body]);
    const Vec2 between = point - position[body];
    if (!(squared_length(between) < touch * touch)) {
      work.normal[pair] = 0.0f;
      work.tangent[pair] = 0.0f;
      continue;
    }
    const Direction normal = direction_of(between);
    StaticContact& contact = contacts[count++];
    contact.body = body;
    contact.anchor_x = point.x - touch * normal.x;
    contact.anchor_y = point.y - touch * normal.y;
    contact.normal_x = normal.x;
    contact.normal_y = normal.y;
    contact.arm = radius + 0.5f * (normal.distance - touch);
    contact.turn = contact.arm * c.inverse_gyration;
    contact.tangent_mass = 1.0f / (1.0f + contact.arm * contact.turn);
    contact.normal_impulse = work.normal[pair];
    contact.tangent_impulse = work.tangent[pair];
    contact.approach = relative_velocity(contact, scratch.motion[body]).normal;
    contact.pair = pair;
    fast |= contact.approach < -c.restitution_threshold;
    visitor.on_contact(kind, list.slot[body], other, Vec2{normal.x, normal.y}, scratch.angle[body], pairs.mark[pair]);
  }
  return {count, fast};
}

}  // namespace hedon
