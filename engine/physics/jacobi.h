/// The contact solver of the paper's released code: biased impulses in Jacobi passes, including its faults.
///
/// In a pass, every contact reads the velocities from the beginning of the pass. Then each body gets the sum of the
/// changes by its contacts, in the order of contacts, so that the sum depends only on the bodies of the island. Crowds
/// separate more slowly than with sequential impulses and bodies overlap by several units, which decides which agent
/// eats. Impulses between bodies are equal and opposite, so pairs of bodies keep their total momentum, up to float
/// rounding.
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

/// Finds the contacts of a batch between bodies, in the order of pairs. A pair that the solver does not act on loses
/// its impulses.
template <class Bodies, class Visitor>
HEDON_FN FoundContacts find_in_order(const Batch<Bodies>& batch, Visitor& visitor) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PairScratch& work = batch.scratch.bodies;
  const BatchRange& range = batch.range;
  const int32_t* first = pairs.first.data;
  const int32_t* second = pairs.second.data;
  const Vec2* position = batch.scratch.position.data;
  const auto reach_of = [&](int32_t pair) { return jacobi_reach(batch.body_touch(first[pair], second[pair])); };
  int32_t* active = batch.scratch.active.data + range.first_body_pair;
  int32_t touching = 0;
  for (int32_t pair = range.first_body_pair; pair < range.last_body_pair; ++pair) {
    const float squared = squared_length(position[second[pair]] - position[first[pair]]);
    const Reach reach = reach_of(pair);
    const bool solid = squared < reach.solid;
    active[touching] = pair;
    touching += squared < reach.touch;
    work.normal[pair] = solid ? work.normal[pair] : 0.0f;
    work.tangent[pair] = solid ? work.tangent[pair] : 0.0f;
  }
  auto* contacts = batch.body_contacts();
  int32_t count = 0;
  bool fast = false;
  for (int32_t i = 0; i < touching; ++i) {
    const int32_t pair = active[i];
    const Vec2 between = position[second[pair]] - position[first[pair]];
    const Direction normal = direction_of(between);
    tell_bodies(batch, pair, {normal.x, normal.y}, visitor);
    if (!(squared_length(between) < reach_of(pair).solid)) continue;
    auto& contact = contacts[count++];
    fill_contact(batch, pair, normal, contact);
    fast |= contact.approach <= -batch.c.restitution_threshold;
  }
  return {count, fast};
}

/// The contacts of a batch in one substep.
template <class Bodies>
struct JacobiContacts {
  typename Bodies::Contact* bodies;
  StaticContact* statics;
  int32_t body_count, static_count;
};

/// One Jacobi pass. `impulse(contact, velocity)` gives the change of the impulses of a contact whose relative
/// velocity is the one at the beginning of the pass.
template <class Bodies, class Impulse>
HEDON_FN void jacobi_pass(const Batch<Bodies>& batch, const JacobiContacts<Bodies>& found, Impulse&& impulse) {
  Motion* motion = batch.scratch.motion.data;
  Motion* change = batch.scratch.change.data;
  for (int32_t i = 0; i < found.body_count; ++i) {
    auto& contact = found.bodies[i];
    const int32_t a = contact.first, b = contact.second;
    const ContactVelocity added = impulse(contact, relative_velocity(contact, motion[a], motion[b]));
    apply(contact, added.normal, added.tangent, change[a], change[b]);
  }
  for (int32_t i = 0; i < found.static_count; ++i) {
    StaticContact& contact = found.statics[i];
    const ContactVelocity added = impulse(contact, relative_velocity(contact, motion[contact.body]));
    apply(contact, added.normal, added.tangent, change[contact.body]);
  }
  for (int32_t index = batch.range.first_index; index < batch.range.last_index; ++index) {
    motion[index].x += change[index].x;
    motion[index].y += change[index].y;
    motion[index].angular += change[index].angular;
    change[index] = {};
  }
}

/// How far two things overlap [u].
template <class Bodies>
HEDON_FN float overlap(const Batch<Bodies>& batch, const BodyContact& contact) {
  return 2.0f * (batch.bodies.radius(contact.first) - contact.arm);
}
template <class Bodies>
HEDON_FN float overlap(const Batch<Bodies>& batch, const MixedContact& contact) {
  return batch.body_touch(contact.first, contact.second) - (contact.arm_first + contact.arm_second);
}
template <class Bodies>
HEDON_FN float overlap(const Batch<Bodies>& batch, const StaticContact& contact) {
  return 2.0f * (batch.bodies.radius(contact.body) - contact.arm);
}

/// Solves one contact separately and returns the change of its impulses. Overlap gives a velocity (a bias) at which
/// the two are to separate; the normal impulse of the pass before limits friction.
/// kept   share of its impulse that a contact starts from: 1, but 0 in the first pass. There it uses velocities as if
///        its stored impulse were applied to the bodies. It never is, so this cancels it.
template <class Bodies, class Contact>
HEDON_FN ContactVelocity solve_biased(Contact& contact, const Batch<Bodies>& batch, ContactVelocity velocity,
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
template <class Bodies>
HEDON_FN void correct_positions_at_once(const Batch<Bodies>& batch, const JacobiContacts<Bodies>& found) {
  Vec2* position = batch.scratch.position.data;
  Motion* change = batch.scratch.change.data;
  for (int32_t i = 0; i < found.body_count; ++i) {
    const auto& contact = found.bodies[i];
    const Vec2 normal{contact.normal_x, contact.normal_y};
    const float touch = batch.body_touch(contact.first, contact.second);
    const float separation = dot(position[contact.second] - position[contact.first], normal) - touch;
    apply(contact, -normal_mass(contact) * correction(batch.c, separation), 0.0f, change[contact.first],
          change[contact.second]);
  }
  for (int32_t i = 0; i < found.static_count; ++i) {
    const StaticContact& contact = found.statics[i];
    const Vec2 normal{contact.normal_x, contact.normal_y}, anchor{contact.anchor_x, contact.anchor_y};
    const float separation = dot(anchor - position[contact.body], normal);
    apply(contact, -normal_mass(contact) * correction(batch.c, separation), 0.0f, change[contact.body]);
  }
  for (int32_t index = batch.range.first_index; index < batch.range.last_index; ++index) {
    position[index].x += change[index].x;
    position[index].y += change[index].y;
    change[index] = {};
  }
}

/// The solver by name `jacobi`, for `try_batch`.
struct JacobiSolver {
  /// Damps and limits velocities, finds contacts, solves, bounces, corrects overlaps, and moves.
  template <class Bodies, class Visitor>
  HEDON_FN static void substep(const Batch<Bodies>& batch, Visitor& visitor) {
    damp(batch);
    const auto nearest = [&](int32_t wall, Vec2 center) { return ring_point(batch.state, wall, center); };
    auto* bodies = batch.body_contacts();
    StaticContact* statics = batch.static_contacts();
    const FoundContacts body = find_in_order(batch, visitor);
    const FoundContacts circle = find_circle_contacts(batch, jacobi_reach, statics, visitor);
    StaticContact* on_walls = statics + circle.count;
    const FoundContacts wall = find_wall_contacts(batch, jacobi_reach, on_walls, visitor, nearest);
    const JacobiContacts<Bodies> found{bodies, statics, body.count, circle.count + wall.count};
    if (found.body_count + found.static_count > 0) {
      for (int32_t pass = 0; pass < batch.config.velocity_passes; ++pass) {
        const float kept = pass == 0 ? 0.0f : 1.0f;
        jacobi_pass(batch, found, [&](auto& contact, ContactVelocity velocity) {
          return solve_biased(contact, batch, velocity, kept);
        });
      }
      if (body.fast || circle.fast || wall.fast) {
        jacobi_pass(batch, found,
                    [&](auto& contact, ContactVelocity velocity) { return bounce_once(contact, batch.c, velocity); });
      }
      keep_impulses(bodies, body.count, batch.scratch.bodies);
      keep_impulses(statics, circle.count, batch.scratch.circles);
      keep_impulses(on_walls, wall.count, batch.scratch.walls);
      for (int32_t pass = 0; pass < batch.config.position_passes; ++pass) correct_positions_at_once(batch, found);
    }
    move(batch);
  }

 private:
  /// Damps the velocities, then limits them: changes by contacts in this substep are not limited.
  template <class Bodies>
  HEDON_FN static void damp(const Batch<Bodies>& batch) {
    const SolverConstants& c = batch.c;
    for (int32_t index = batch.range.first_index; index < batch.range.last_index; ++index) {
      Motion& motion = batch.scratch.motion[index];
      motion.x = clamp(motion.x * c.linear_decay, -c.max_speed, c.max_speed);
      motion.y = clamp(motion.y * c.linear_decay, -c.max_speed, c.max_speed);
      motion.angular = clamp(motion.angular * c.angular_decay, -c.max_angular_speed, c.max_angular_speed);
      batch.scratch.change[index] = {};
    }
  }

  template <class Bodies>
  HEDON_FN static void move(const Batch<Bodies>& batch) {
    const PhysicsScratch& scratch = batch.scratch;
    for (int32_t index = batch.range.first_index; index < batch.range.last_index; ++index) {
      scratch.position[index].x += scratch.motion[index].x * batch.c.dt;
      scratch.position[index].y += scratch.motion[index].y * batch.c.dt;
      scratch.angle[index] += scratch.motion[index].angular * batch.c.dt;
      keep_inside(batch, index);
    }
  }

  /// Puts a body whose center was pushed through an outer wall back onto it. A wall does not push a center that lies
  /// behind it, so the body would leave the arena for good.
  template <class Bodies>
  HEDON_FN static void keep_inside(const Batch<Bodies>& batch, int32_t index) {
    constexpr float MARGIN = 1.0e-3f;  ///< from the wall [u]
    const PairList& walls = batch.state.neighbors.walls;
    Vec2& center = batch.scratch.position[index];
    for (int32_t pair = walls.start[index]; pair < walls.start[index + 1]; ++pair) {
      if (walls.second[pair] >= batch.state.outer_walls) continue;
      const Segment& wall = batch.state.walls[walls.second[pair]];
      const Vec2 along = wall.b - wall.a;  // the outer walls run clockwise, so the inside is to their right
      const float behind = -cross(center - wall.a, along) / length(along);
      if (!(behind > 0.0f)) continue;
      const float shift = (behind + MARGIN) / length(along);
      center = center + shift * Vec2{along.y, -along.x};
    }
  }
};

}  // namespace hedon
