/// A batch of a step. Finds its contacts, reports them to the visitor and fills them in for the solver.
#pragma once

#include <cstdint>

#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

/// Bits of a pair's mark: one for each of its bodies. A body is the first of its pairs with static objects.
inline constexpr uint8_t FIRST = 1, SECOND = 2;

/// The indices and pairs of one batch.
struct BatchRange {
  int32_t number;
  int32_t first_index, last_index;
  int32_t first_body_pair, last_body_pair;
  int32_t first_circle_pair, last_circle_pair;
  int32_t first_wall_pair, last_wall_pair;
};

HEDON_FN BatchRange batch_range(const NeighborList& list, int32_t batch) {
  const NeighborHead& head = list.head[0];
  const int32_t first = head.batch_start[batch], last = head.batch_start[batch + 1];
  return {batch,
          first,
          last,
          list.bodies.start[first],
          list.bodies.start[last],
          list.circles.start[first],
          list.circles.start[last],
          list.walls.start[first],
          list.walls.start[last]};
}

/// All bodies are of one class, so their mass cancels in every contact.
struct AlikeBodies {
  using Contact = BodyContact;
  float size, inverse_of_mass, inverse_of_inertia, gyration;

  HEDON_FN AlikeBodies(const BodyTable& table, const PhysicsState&, const PhysicsScratch&)
      : size(table.shape[0].radius),
        inverse_of_mass(1.0f / table.shape[0].mass),
        inverse_of_inertia(1.0f / table.shape[0].inertia),
        gyration(table.shape[0].mass / table.shape[0].inertia) {}

  HEDON_FN static void note(int32_t, int32_t) {}
  HEDON_FN float radius(int32_t) const { return size; }
  HEDON_FN float inverse_mass(int32_t) const { return inverse_of_mass; }
  HEDON_FN float inverse_inertia(int32_t) const { return inverse_of_inertia; }
  HEDON_FN float inverse_gyration(int32_t) const { return gyration; }
  HEDON_FN static float for_lightest(int32_t, float squared_force) { return squared_force; }
  HEDON_FN static BodyContact* contacts(const PhysicsScratch& scratch) { return scratch.body_contacts.data; }
};

/// Bodies of several shapes, by their index in the list.
struct MixedBodies {
  using Contact = MixedContact;
  const BodyTable& table;
  const PhysicsState& state;
  BodyShape* shape;  ///< by index
  float lightest;    ///< smallest possible mass of a body

  HEDON_FN MixedBodies(const BodyTable& classes, const PhysicsState& now, const PhysicsScratch& scratch)
      : table(classes), state(now), shape(scratch.shape.data), lightest(classes.min_mass()) {}

  /// Copies the shape of a body; call it first in each step.
  HEDON_FN void note(int32_t index, int32_t slot) const { shape[index] = shape_of(state, table, slot); }
  HEDON_FN float radius(int32_t index) const { return shape[index].radius; }
  HEDON_FN float inverse_mass(int32_t index) const { return 1.0f / shape[index].mass; }
  HEDON_FN float inverse_inertia(int32_t index) const { return 1.0f / shape[index].inertia; }
  HEDON_FN float inverse_gyration(int32_t index) const { return shape[index].mass / shape[index].inertia; }
  /// Change of velocity per impulse: the mass of the first class divided by the body's mass.
  HEDON_FN float weight(int32_t index) const { return table.shape[0].mass / shape[index].mass; }
  /// The squared force that would push the lightest possible body as much as this one does the body.
  HEDON_FN float for_lightest(int32_t index, float squared_force) const {
    const float ratio = lightest / shape[index].mass;
    return squared_force * ratio * ratio;
  }
  HEDON_FN static MixedContact* contacts(const PhysicsScratch& scratch) { return scratch.mixed_contacts.data; }
};

/// The input of a solver: one batch in one step, and the workers on it.
template <class Bodies, class Workers>
struct Batch {
  using Crew = Workers;
  using Contact = typename Bodies::Contact;
  Crew crew;
  const PhysicsConfig& config;
  const Bodies& bodies;
  const BodyTable& table;
  const SolverConstants& c;
  const PhysicsState& state;
  const PhysicsScratch& scratch;
  BatchRange range;

  /// Distance at which two centers just touch [u].
  HEDON_FN float body_touch(int32_t first, int32_t second) const {
    return bodies.radius(first) + bodies.radius(second);
  }

  /// The contacts of the batch. Those with circles and then those with walls share an array.
  HEDON_FN Contact* body_contacts() const { return Bodies::contacts(scratch) + range.first_body_pair; }
  HEDON_FN StaticContact* static_contacts() const {
    return scratch.static_contacts.data + range.first_circle_pair + range.first_wall_pair;
  }
  /// Where the contacts of each color begin.
  HEDON_FN int32_t* color_start() const { return scratch.color_start.data + range.number * (COLORS + 1); }

  /// Calls body(index) for each body.
  template <class Body>
  HEDON_FN void each_body(Body&& body) const {
    crew.each(range.first_index, range.last_index, body);
  }
};

/// Moves a body whose center has passed through an outer wall back onto it. A small body can do so in one substep, and
/// others can be pushed through. A wall does not push a center that is behind it, so the body would never return.
template <class Bodies, class Crew>
HEDON_FN void keep_inside(const Batch<Bodies, Crew>& batch, int32_t index) {
  constexpr float MARGIN = 1.0e-3f;  ///< from the wall [u]
  const PairList& walls = batch.state.neighbors.walls;
  Vec2& center = batch.scratch.position[index];
  for (int32_t pair = walls.start[index]; pair < walls.start[index + 1]; ++pair) {
    if (walls.second[pair] >= batch.state.outer_walls) continue;
    const Segment& wall = batch.state.walls[walls.second[pair]];
    const Vec2 along = wall.b - wall.a;  // the outer walls run clockwise, so the inside is to their right
    const float inside = cross(center - wall.a, along);
    if (!(inside < 0.0f)) continue;
    const float shift = (-inside / length(along) + MARGIN) / length(along);
    center = center + shift * Vec2{along.y, -along.x};
  }
}

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

/// The contacts of a batch: first with circles, then with walls. Within each part, the contacts of one body are
/// consecutive, and act in this order.
struct StaticContacts {
  StaticContact* contact;
  int32_t circles;  ///< how many are with circles
  int32_t count;
  bool fast;  ///< whether any approaches so fast that it may bounce

  /// Calls body(contact) for each.
  template <class Crew, class Body>
  HEDON_FN void each(const Crew& crew, Body&& body) const {
    const auto follows = [&](int32_t i) { return contact[i - 1].body == contact[i].body; };
    const auto one = [&](int32_t i) { body(contact[i]); };
    crew.each_in_runs(0, circles, follows, one);
    crew.each_in_runs(circles, count, follows, one);
  }
};

/// Reports two bodies that touch to the visitor, once for each.
template <class Bodies, class Crew, class Visitor>
HEDON_FN void tell_bodies(const Batch<Bodies, Crew>& batch, int32_t pair, Vec2 normal, Visitor& visitor) {
  const NeighborList& list = batch.state.neighbors;
  const int32_t first = list.bodies.first[pair], second = list.bodies.second[pair];
  const int32_t a = list.slot[first], b = list.slot[second];
  visitor.on_contact(batch.crew, PairKind::body, a, b, normal, batch.scratch.angle[first], FIRST,
                     list.bodies.mark[pair]);
  visitor.on_contact(batch.crew, PairKind::body, b, a, -normal, batch.scratch.angle[second], SECOND,
                     list.bodies.mark[pair]);
}

/// Fills in the contact of a pair of bodies, with the stored impulses of the pair.
template <class Bodies, class Crew>
HEDON_FN void fill_contact(const Batch<Bodies, Crew>& batch, int32_t pair, const Direction& normal,
                           BodyContact& contact) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PhysicsScratch& scratch = batch.scratch;
  contact.first = pairs.first[pair];
  contact.second = pairs.second[pair];
  contact.normal_x = normal.x;
  contact.normal_y = normal.y;
  contact.arm = 0.5f * normal.distance;
  contact.turn = contact.arm * batch.bodies.inverse_gyration(contact.first);
  contact.tangent_mass = 0.5f / (1.0f + contact.arm * contact.turn);
  contact.normal_impulse = scratch.bodies.normal[pair];
  contact.tangent_impulse = scratch.bodies.tangent[pair];
  contact.approach = relative_velocity(contact, scratch.motion[contact.first], scratch.motion[contact.second]).normal;
  contact.pair = pair;
}

template <class Bodies, class Crew>
HEDON_FN void fill_contact(const Batch<Bodies, Crew>& batch, int32_t pair, const Direction& normal,
                           MixedContact& contact) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PhysicsScratch& scratch = batch.scratch;
  const Bodies& bodies = batch.bodies;
  const int32_t a = contact.first = pairs.first[pair], b = contact.second = pairs.second[pair];
  contact.normal_x = normal.x;
  contact.normal_y = normal.y;
  contact.arm_first = 0.5f * (normal.distance + (bodies.radius(a) - bodies.radius(b)));
  contact.arm_second = 0.5f * (normal.distance - (bodies.radius(a) - bodies.radius(b)));
  contact.weight_first = bodies.weight(a);
  contact.weight_second = bodies.weight(b);
  contact.turn_first = contact.weight_first * contact.arm_first * batch.bodies.inverse_gyration(a);
  contact.turn_second = contact.weight_second * contact.arm_second * batch.bodies.inverse_gyration(b);
  contact.normal_mass = 1.0f / (contact.weight_first + contact.weight_second);
  contact.tangent_mass = 1.0f / ((contact.weight_first + contact.arm_first * contact.turn_first) +
                                 (contact.weight_second + contact.arm_second * contact.turn_second));
  contact.normal_impulse = scratch.bodies.normal[pair];
  contact.tangent_impulse = scratch.bodies.tangent[pair];
  contact.approach = relative_velocity(contact, scratch.motion[a], scratch.motion[b]).normal;
  contact.pair = pair;
}

/// Fills in the contact of a body with a static object, whose nearest point is `point`. The centers, or center and
/// wall, just touch at a distance of `touch` [u].
template <class Bodies, class Crew>
HEDON_FN void fill_contact(const Batch<Bodies, Crew>& batch, const PairList& pairs, const PairScratch& work,
                           int32_t pair, Vec2 point, const Direction& normal, float touch, const Material& material,
                           StaticContact& contact) {
  contact.body = pairs.first[pair];
  contact.anchor_x = point.x - touch * normal.x;
  contact.anchor_y = point.y - touch * normal.y;
  contact.normal_x = normal.x;
  contact.normal_y = normal.y;
  contact.arm = batch.bodies.radius(contact.body) + 0.5f * (normal.distance - touch);
  contact.turn = contact.arm * batch.bodies.inverse_gyration(contact.body);
  contact.tangent_mass = 1.0f / (1.0f + contact.arm * contact.turn);
  contact.friction = material.friction;
  contact.restitution = material.restitution;
  contact.normal_impulse = work.normal[pair];
  contact.tangent_impulse = work.tangent[pair];
  contact.approach = relative_velocity(contact, batch.scratch.motion[contact.body]).normal;
  contact.pair = pair;
}

/// Finds the contacts of a batch with circles or walls; returns how many there are. A pair that the solver does not act
/// on loses its impulses.
/// nearest(other, center)   the relevant point of the circle or wall
/// touch_of(body)           distance at which they just touch [u]
/// reach_of(touch)          squared distances below which they touch, and below which the solver acts on them [u²]
/// fast                     becomes true if any contact approaches so fast that it may bounce
template <class Bodies, class Crew, class Visitor, class Touch, class ReachOf, class Nearest>
HEDON_FN int32_t find_contacts(PairKind kind, const Batch<Bodies, Crew>& batch, const PairList& pairs,
                               const PairScratch& work, int32_t first_pair, int32_t last_pair, Touch&& touch_of,
                               ReachOf&& reach_of, StaticContact* contacts, bool& fast, Visitor& visitor,
                               Nearest&& nearest) {
  const PhysicsScratch& scratch = batch.scratch;
  const Vec2* position = scratch.position.data;
  const auto tell = [&](int32_t pair, const Direction& normal) {
    const int32_t body = pairs.first[pair];
    visitor.on_contact(batch.crew, kind, batch.state.neighbors.slot[body], pairs.second[pair], Vec2{normal.x, normal.y},
                       scratch.angle[body], FIRST, pairs.mark[pair]);
  };
  const auto acts = [&](int32_t pair) {
    const int32_t body = pairs.first[pair];
    const Reach reach = reach_of(touch_of(body));
    const Vec2 between = nearest(pairs.second[pair], position[body]) - position[body];
    const float squared = squared_length(between);
    if (squared < reach.solid) return true;
    work.normal[pair] = 0.0f;
    work.tangent[pair] = 0.0f;
    if (squared < reach.touch) tell(pair, direction_of(between));
    return false;
  };
  const int32_t count =
      batch.crew.select(first_pair, last_pair, acts, [&](int32_t at, int32_t pair) { contacts[at].pair = pair; });
  batch.crew.each(0, count, [&](int32_t i) {
    const int32_t pair = contacts[i].pair, body = pairs.first[pair], other = pairs.second[pair];
    const Vec2 point = nearest(other, position[body]);
    const Direction normal = direction_of(point - position[body]);
    const bool obstacle = kind == PairKind::wall && other >= batch.table.first_obstacle;
    const Material material = obstacle ? batch.table.obstacle : Material{batch.c.friction, batch.c.restitution};
    fill_contact(batch, pairs, work, pair, point, normal, touch_of(body), material, contacts[i]);
    fast |= contacts[i].approach <= -batch.c.restitution_threshold;
    tell(pair, normal);
  });
  return count;
}

/// Finds the contacts of a batch with circles and walls. `nearest(wall, center)` gives the relevant point of a wall.
template <class Bodies, class Crew, class Visitor, class ReachOf, class Nearest>
HEDON_FN StaticContacts find_static_contacts(const Batch<Bodies, Crew>& batch, ReachOf&& reach_of, Visitor& visitor,
                                             Nearest&& nearest) {
  const NeighborList& list = batch.state.neighbors;
  const StaticCircles& circles = batch.state.circles;
  const BatchRange& range = batch.range;
  const auto center = [&](int32_t circle, Vec2) { return Vec2{circles.x[circle], circles.y[circle]}; };
  const auto circle_touch = [bodies = batch.bodies, radius = batch.table.circle_radius](int32_t body) {
    return bodies.radius(body) + radius;
  };
  const auto wall_touch = [bodies = batch.bodies](int32_t body) { return bodies.radius(body); };
  StaticContact* contacts = batch.static_contacts();
  bool fast = false;
  const int32_t on_circles =
      find_contacts(PairKind::circle, batch, list.circles, batch.scratch.circles, range.first_circle_pair,
                    range.last_circle_pair, circle_touch, reach_of, contacts, fast, visitor, center);
  const int32_t on_walls =
      find_contacts(PairKind::wall, batch, list.walls, batch.scratch.walls, range.first_wall_pair, range.last_wall_pair,
                    wall_touch, reach_of, contacts + on_circles, fast, visitor, nearest);
  return {contacts, on_circles, on_circles + on_walls, batch.crew.any(fast)};
}

/// Keeps the impulses of contacts for the next substep.
template <class Bodies, class Crew, class Contact>
HEDON_FN void keep_impulses(const Batch<Bodies, Crew>& batch, const Contact* contacts, int32_t count) {
  batch.crew.each(0, count, [&](int32_t i) { keep_impulse(contacts[i], batch.scratch.bodies); });
}

template <class Bodies, class Crew>
HEDON_FN void keep_impulses(const Batch<Bodies, Crew>& batch, const StaticContacts& found) {
  batch.crew.each(0, found.count, [&](int32_t i) {
    const StaticContact& contact = found.contact[i];
    keep_impulse(contact, i < found.circles ? batch.scratch.circles : batch.scratch.walls);
  });
}

}  // namespace hedon
