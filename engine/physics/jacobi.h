/// The contact solver of the paper's released code: biased impulses in Jacobi passes, including its faults.
///
/// In a pass, every contact reads the velocities at the start of the pass. Then the changes from a body's contacts are
/// added to it in the order of contacts, so that the sum depends only on the bodies of the island. Crowds separate more
/// slowly than with sequential impulses and bodies overlap by several units, which decides which agent eats. Impulses
/// between bodies are equal and opposite, so pairs of bodies keep their total momentum, up to float rounding.
#pragma once

#include <cfloat>
#include <cstdint>
#include <limits>

#include "physics/detect.h"
#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

/// Overlap from which the solver acts [u]. In the released code, a distance before contact was intended, but its sign
/// is wrong.
inline constexpr float LEAST_DEPTH = 0.02f;

/// The squared distances for centers that just touch at `touch` [u]; just touching counts as touching.
HEDON_FN Reach jacobi_reach(float touch) {
  const float solid = touch - LEAST_DEPTH;
  return {touch * touch * (1.0f + FLT_EPSILON), solid * solid * (1.0f + FLT_EPSILON)};
}

/// The relevant point of an outer wall for a body; infinitely far away if there is none: behind the wall, and beyond
/// its ends by a rule in which the released code confuses the neighbors of the two ends. Inner walls have no neighbors
/// and are solid on both sides.
HEDON_FN Vec2 ring_point(const PhysicsState& state, int32_t wall, Vec2 center) {
  const Array<Segment>& walls = state.walls;
  const Vec2 a = walls[wall].a, b = walls[wall].b;
  const int32_t ring = state.outer_walls;
  if (wall < ring) {
    constexpr float FAR = std::numeric_limits<float>::infinity();
    const Vec2 before = walls[wall == 0 ? ring - 1 : wall - 1].a, after = walls[wall + 1 == ring ? 0 : wall + 1].b;
    const bool behind = cross(center - a, b - a) < 0.0f;
    const bool short_of_a = dot(center - a, b - a) <= 0.0f && dot(after - b, center - b) > 0.0f;
    const bool past_b = dot(b - center, b - a) <= 0.0f && dot(a - before, center - a) <= 0.0f;
    if (behind || short_of_a || past_b) return {FAR, FAR};
  }
  return nearest_on_segment(a, b, center);
}

/// The contacts of a batch between bodies, in the order of pairs.
template <class Contact>
struct OrderedContacts {
  Contact* contact;
  int32_t count;
  bool fast;  ///< whether any approaches so fast that it may bounce

  /// Calls body(contact) for each, one after another.
  template <class Crew, class Body>
  HEDON_FN void each(const Crew& crew, Body&& body) const {
    crew.once([&] {
      for (int32_t i = 0; i < count; ++i) body(contact[i]);
    });
  }
};

/// Finds the contacts of a batch between bodies. A pair that the solver does not act on loses its impulses.
template <class Bodies, class Crew, class Visitor>
HEDON_FN OrderedContacts<typename Bodies::Contact> find_in_order(const Batch<Bodies, Crew>& batch, Visitor& visitor) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PairScratch& work = batch.scratch.bodies;
  const BatchRange& range = batch.range;
  const int32_t* first = pairs.first.data;
  const int32_t* second = pairs.second.data;
  const Vec2* position = batch.scratch.position.data;
  const auto acts = [&](int32_t pair) {
    const Vec2 between = position[second[pair]] - position[first[pair]];
    const float squared = squared_length(between);
    const Reach reach = jacobi_reach(batch.body_touch(first[pair], second[pair]));
    const bool solid = squared < reach.solid;
    work.normal[pair] = solid ? work.normal[pair] : 0.0f;
    work.tangent[pair] = solid ? work.tangent[pair] : 0.0f;
    if (!solid && squared < reach.touch) {
      const Direction normal = direction_of(between);
      tell_bodies(batch, pair, {normal.x, normal.y}, visitor);
    }
    return solid;
  };
  int32_t* active = batch.scratch.active.data + range.first_body_pair;
  const int32_t count = batch.crew.select(range.first_body_pair, range.last_body_pair, acts,
                                          [&](int32_t at, int32_t pair) { active[at] = pair; });
  auto* contacts = batch.body_contacts();
  bool fast = false;
  batch.crew.each(0, count, [&](int32_t i) {
    const int32_t pair = active[i];
    const Direction normal = direction_of(position[second[pair]] - position[first[pair]]);
    fill_contact(batch, pair, normal, contacts[i]);
    fast |= contacts[i].approach <= -batch.c.restitution_threshold;
    tell_bodies(batch, pair, {normal.x, normal.y}, visitor);
  });
  return {contacts, count, batch.crew.any(fast)};
}

/// The contacts of a batch in one substep.
template <class Contact>
struct JacobiContacts {
  OrderedContacts<Contact> bodies;
  StaticContacts statics;
};

/// Adds the changes from the contacts of a pass to each body, and clears them.
template <class Bodies, class Crew, class Add>
HEDON_FN void add_changes(const Batch<Bodies, Crew>& batch, Add&& add) {
  batch.each_body([&](int32_t index) {
    Motion& change = batch.scratch.change[index];
    add(index, change);
    change = {};
  });
}

/// One Jacobi pass. `impulse(contact, velocity)` gives the change of the impulses of a contact whose relative
/// velocity is the one at the beginning of the pass.
template <class Bodies, class Crew, class Impulse>
HEDON_FN void jacobi_pass(const Batch<Bodies, Crew>& batch, const JacobiContacts<typename Bodies::Contact>& found,
                          Impulse&& impulse) {
  Motion* motion = batch.scratch.motion.data;
  Motion* change = batch.scratch.change.data;
  found.bodies.each(batch.crew, [&](auto& contact) {
    const int32_t a = contact.first, b = contact.second;
    const ContactVelocity added = impulse(contact, relative_velocity(contact, motion[a], motion[b]));
    apply(contact, added.normal, added.tangent, change[a], change[b]);
  });
  found.statics.each(batch.crew, [&](StaticContact& contact) {
    const ContactVelocity added = impulse(contact, relative_velocity(contact, motion[contact.body]));
    apply(contact, added.normal, added.tangent, change[contact.body]);
  });
  add_changes(batch, [&](int32_t index, const Motion& added) {
    motion[index].x += added.x;
    motion[index].y += added.y;
    motion[index].angular += added.angular;
  });
}

/// The depth of an overlap [u].
template <class Bodies, class Crew>
HEDON_FN float overlap(const Batch<Bodies, Crew>& batch, const BodyContact& contact) {
  return 2.0f * (batch.bodies.radius(contact.first) - contact.arm);
}
template <class Bodies, class Crew>
HEDON_FN float overlap(const Batch<Bodies, Crew>& batch, const MixedContact& contact) {
  return batch.body_touch(contact.first, contact.second) - (contact.arm_first + contact.arm_second);
}
template <class Bodies, class Crew>
HEDON_FN float overlap(const Batch<Bodies, Crew>& batch, const StaticContact& contact) {
  return 2.0f * (batch.bodies.radius(contact.body) - contact.arm);
}

/// Solves one contact separately and returns the change of its impulses. Overlap gives a velocity (a bias) at which
/// the two are to separate; the normal impulse of the pass before limits friction.
/// kept   share of the stored impulse that a contact starts from: 1, but 0 in the first pass. The first pass uses
///        velocities as if the stored impulse had been applied to the bodies. It never is, so this cancels it.
template <class Bodies, class Crew, class Contact>
HEDON_FN ContactVelocity solve_biased(Contact& contact, const Batch<Bodies, Crew>& batch, ContactVelocity velocity,
                                      float kept) {
  const SolverConstants& c = batch.c;
  const float depth = overlap(batch, contact);
  const float bias = c.correction_rate / c.dt * (depth > c.slop ? depth - c.slop : 0.0f);
  const float limit = material(contact, c).friction * contact.normal_impulse;
  const float tangent = clamp(kept * contact.tangent_impulse - contact.tangent_mass * velocity.tangent, -limit, limit);
  const float pushed = kept * contact.normal_impulse + normal_mass(contact) * (bias - velocity.normal);
  const float normal = pushed > 0.0f ? pushed : 0.0f;
  const ContactVelocity change{normal - contact.normal_impulse, tangent - contact.tangent_impulse};
  contact.normal_impulse = normal;
  contact.tangent_impulse = tangent;
  return change;
}

/// The impulse after which a contact that approached fast separates at `restitution` times that speed. Earlier impulses
/// do not limit it, and it is not stored.
template <class Contact>
HEDON_FN ContactVelocity bounce_once(const Contact& contact, const SolverConstants& c, ContactVelocity velocity) {
  if (!(contact.approach <= -c.restitution_threshold)) return {0.0f, 0.0f};
  return {-normal_mass(contact) * (velocity.normal + material(contact, c).restitution * contact.approach), 0.0f};
}

/// One Jacobi pass of position correction, before the bodies move, along the normals of the contacts.
template <class Bodies, class Crew>
HEDON_FN void correct_positions_at_once(const Batch<Bodies, Crew>& batch,
                                        const JacobiContacts<typename Bodies::Contact>& found) {
  Vec2* position = batch.scratch.position.data;
  Motion* change = batch.scratch.change.data;
  found.bodies.each(batch.crew, [&](const auto& contact) {
    const Vec2 normal{contact.normal_x, contact.normal_y};
    const float touch = batch.body_touch(contact.first, contact.second);
    const float separation = dot(position[contact.second] - position[contact.first], normal) - touch;
    apply(contact, -normal_mass(contact) * correction(batch.c, separation), 0.0f, change[contact.first],
          change[contact.second]);
  });
  found.statics.each(batch.crew, [&](const StaticContact& contact) {
    const Vec2 normal{contact.normal_x, contact.normal_y}, anchor{contact.anchor_x, contact.anchor_y};
    const float separation = dot(anchor - position[contact.body], normal);
    apply(contact, -normal_mass(contact) * correction(batch.c, separation), 0.0f, change[contact.body]);
  });
  add_changes(batch, [&](int32_t index, const Motion& added) {
    position[index].x += added.x;
    position[index].y += added.y;
  });
}

/// The solver by name `jacobi`, for `try_batch`.
struct JacobiSolver {
  /// Damps and limits velocities, finds contacts, solves, bounces, corrects overlaps, and moves.
  template <class Bodies, class Crew, class Visitor>
  HEDON_FN static void substep(const Batch<Bodies, Crew>& batch, Visitor& visitor) {
    damp(batch);
    const auto nearest = [&](int32_t wall, Vec2 center) { return ring_point(batch.state, wall, center); };
    const auto bodies = find_in_order(batch, visitor);
    const StaticContacts statics = find_static_contacts(batch, jacobi_reach, visitor, nearest);
    const JacobiContacts<typename Bodies::Contact> found{bodies, statics};
    if (bodies.count + statics.count > 0) {
      for (int32_t pass = 0; pass < batch.config.velocity_passes; ++pass) {
        const float kept = pass == 0 ? 0.0f : 1.0f;
        jacobi_pass(batch, found, [&](auto& contact, ContactVelocity velocity) {
          return solve_biased(contact, batch, velocity, kept);
        });
      }
      if (bodies.fast || statics.fast) {
        jacobi_pass(batch, found,
                    [&](auto& contact, ContactVelocity velocity) { return bounce_once(contact, batch.c, velocity); });
      }
      keep_impulses(batch, bodies.contact, bodies.count);
      keep_impulses(batch, statics);
      for (int32_t pass = 0; pass < batch.config.position_passes; ++pass) correct_positions_at_once(batch, found);
    }
    move(batch);
  }

 private:
  /// Damps the velocities, then limits them: changes by contacts in this substep are not limited.
  template <class Bodies, class Crew>
  HEDON_FN static void damp(const Batch<Bodies, Crew>& batch) {
    const SolverConstants& c = batch.c;
    batch.each_body([&](int32_t index) {
      Motion& motion = batch.scratch.motion[index];
      motion.x = clamp(motion.x * c.linear_decay, -c.max_speed, c.max_speed);
      motion.y = clamp(motion.y * c.linear_decay, -c.max_speed, c.max_speed);
      motion.angular = clamp(motion.angular * c.angular_decay, -c.max_angular_speed, c.max_angular_speed);
      batch.scratch.change[index] = {};
    });
  }

  template <class Bodies, class Crew>
  HEDON_FN static void move(const Batch<Bodies, Crew>& batch) {
    const PhysicsScratch& scratch = batch.scratch;
    batch.each_body([&](int32_t index) {
      scratch.position[index].x += scratch.motion[index].x * batch.c.dt;
      scratch.position[index].y += scratch.motion[index].y * batch.c.dt;
      scratch.angle[index] += scratch.motion[index].angular * batch.c.dt;
      keep_inside(batch, index);
    });
  }
};

}  // namespace hedon
