/// Sequential impulses and position correction for the contacts of one batch and one substep.
///
/// Source: Catto (2005), "Iterative dynamics with temporal coherence"; the order of the parts is Box2D's. Since a
/// disc's friction does not change its normal velocity, both are computed from the same velocities. The normal impulse
/// of the pass before limits friction. Invariant: every pair of bodies keeps its total momentum, up to float rounding.
#pragma once

#include <bit>
#include <cstdint>

#include "physics/detect.h"
#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

inline constexpr int COLORS = 32;

/// Finds the contacts of a batch between bodies, in the order of colors: no two of one color share a body, so that
/// consecutive contacts do not wait for one another. Only overlapping pairs get a color, in canonical order. So the
/// order of two contacts that share a body depends only on the contacts of their own cluster. A pair that does not
/// overlap loses its impulses. Contacts are written from `first_body_pair` on. Each contact is reported to the visitor
/// twice, once for each body.
template <class Bodies, class Visitor>
HEDON_FN FoundContacts find_in_colors(const Batch<Bodies>& batch, Visitor& visitor) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PhysicsScratch& scratch = batch.scratch;
  const BatchRange& range = batch.range;
  const int32_t* first = pairs.first.data;
  const int32_t* second = pairs.second.data;
  float* normal_impulse = scratch.bodies.normal.data;
  float* tangent_impulse = scratch.bodies.tangent.data;
  const Vec2* position = scratch.position.data;
  const Bodies bodies = batch.bodies;
  int32_t* active = scratch.active.data + range.first_body_pair;
  int32_t count = 0;
  for (int32_t pair = range.first_body_pair; pair < range.last_body_pair; ++pair) {
    const float touch = bodies.radius(first[pair]) + bodies.radius(second[pair]);
    const bool touching = squared_length(position[second[pair]] - position[first[pair]]) < touch * touch;
    active[count] = pair;
    count += touching;
    normal_impulse[pair] = touching ? normal_impulse[pair] : 0.0f;
    tangent_impulse[pair] = touching ? tangent_impulse[pair] : 0.0f;
  }
  if (count == 0) return {0, false};

  uint32_t* colors = scratch.colors.data;
  uint8_t* color = scratch.color.data + range.first_body_pair;
  for (int32_t index = range.first_index; index < range.last_index; ++index) colors[index] = 0;
  int32_t next[COLORS + 1] = {};
  for (int32_t i = 0; i < count; ++i) {
    uint32_t& a = colors[first[active[i]]];
    uint32_t& b = colors[second[active[i]]];
    // The last color takes all remaining contacts; they may share bodies, which only costs time.
    const int taken = std::countr_zero(~(a | b) | 0x80000000u);
    a |= 1u << taken;
    b |= 1u << taken;
    color[i] = static_cast<uint8_t>(taken);
    ++next[taken + 1];
  }
  for (int taken = 0; taken < COLORS; ++taken) next[taken + 1] += next[taken];

  auto* contacts = batch.body_contacts();
  bool fast = false;
  for (int32_t i = 0; i < count; ++i) {
    const int32_t pair = active[i];
    auto& contact = contacts[next[color[i]]++];
    const Direction normal = direction_of(position[second[pair]] - position[first[pair]]);
    fill_contact(batch, pair, normal, contact);
    fast |= contact.approach < -batch.c.restitution_threshold;
    tell_bodies(batch, pair, {normal.x, normal.y}, visitor);
  }
  return {count, fast};
}

/// Accumulates one solution of a contact; returns by how much the impulses changed.
template <class Contact>
HEDON_FN ContactVelocity accumulate(Contact& contact, const SolverConstants& c, ContactVelocity velocity) {
  const float limit = material(contact, c).friction * contact.normal_impulse;
  const float tangent = clamp(contact.tangent_impulse - contact.tangent_mass * velocity.tangent, -limit, limit);
  const float pushed = contact.normal_impulse - normal_mass(contact) * velocity.normal;
  const float normal = pushed > 0.0f ? pushed : 0.0f;
  const ContactVelocity change{normal - contact.normal_impulse, tangent - contact.tangent_impulse};
  contact.normal_impulse = normal;
  contact.tangent_impulse = tangent;
  return change;
}

/// One pass of projected Gauss-Seidel over contacts between bodies.
template <class Contact>
HEDON_FN void solve_velocity(Contact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    Contact& contact = contacts[i];
    Motion &a = motion[contact.first], &b = motion[contact.second];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a, b));
    apply(contact, change.normal, change.tangent, a, b);
  }
}

/// One pass of projected Gauss-Seidel over contacts with static objects.
HEDON_FN void solve_velocity(StaticContact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    StaticContact& contact = contacts[i];
    Motion& a = motion[contact.body];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a));
    apply(contact, change.normal, change.tangent, a);
  }
}

/// Applies the impulses of the substep before.
template <class Contact>
HEDON_FN void warm_start(const Contact* contacts, int32_t count, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    const Contact& contact = contacts[i];
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.first], motion[contact.second]);
  }
}

HEDON_FN void warm_start(const StaticContact* contacts, int32_t count, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    const StaticContact& contact = contacts[i];
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.body]);
  }
}

/// Normal impulse per mass after which a contact separates at `restitution` times its approach speed; 0 if it was slow
/// or had no impulse.
template <class Contact>
HEDON_FN float bounce(Contact& contact, const SolverConstants& c, float normal_velocity) {
  if (!(contact.approach < -c.restitution_threshold) || !(contact.normal_impulse > 0.0f)) return 0.0f;
  const float wanted = normal_velocity + material(contact, c).restitution * contact.approach;
  const float pushed = contact.normal_impulse - normal_mass(contact) * wanted;
  const float normal = pushed > 0.0f ? pushed : 0.0f;
  const float change = normal - contact.normal_impulse;
  contact.normal_impulse = normal;
  return change;
}

template <class Contact>
HEDON_FN void apply_restitution(Contact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    Contact& contact = contacts[i];
    Motion &a = motion[contact.first], &b = motion[contact.second];
    const float change = bounce(contact, c, relative_velocity(contact, a, b).normal);
    if (change != 0.0f) apply(contact, change, 0.0f, a, b);
  }
}

HEDON_FN void apply_restitution(StaticContact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    StaticContact& contact = contacts[i];
    Motion& a = motion[contact.body];
    const float change = bounce(contact, c, relative_velocity(contact, a).normal);
    if (change != 0.0f) apply(contact, change, 0.0f, a);
  }
}

/// One pass of position correction between bodies: of two equal ones, each moves half the distance. The separation is
/// measured between the present positions along the normal of the contact; after the motion of one substep it differs
/// from the true one by less than the slop.
template <class Bodies>
HEDON_FN void correct_positions(const Batch<Bodies>& batch, const typename Bodies::Contact* contacts, int32_t count,
                                Vec2* position) {
  for (int32_t i = 0; i < count; ++i) {
    const auto& contact = contacts[i];
    const float touch = batch.body_touch(contact.first, contact.second);
    const Vec2 normal{contact.normal_x, contact.normal_y};
    const Vec2 a = position[contact.first], b = position[contact.second];
    const float push = correction(batch.c, dot(b - a, normal) - touch);
    const Shares share = shares(contact);
    position[contact.first] = a + (share.first * push) * normal;
    position[contact.second] = b - (share.second * push) * normal;
  }
}

/// One pass of position correction against static objects.
HEDON_FN void correct_positions(const StaticContact* contacts, int32_t count, const SolverConstants& c,
                                Vec2* position) {
  for (int32_t i = 0; i < count; ++i) {
    const StaticContact& contact = contacts[i];
    const Vec2 normal{contact.normal_x, contact.normal_y}, anchor{contact.anchor_x, contact.anchor_y};
    const Vec2 a = position[contact.body];
    position[contact.body] = a + correction(c, dot(anchor - a, normal)) * normal;
  }
}

/// Limits the velocities and moves the bodies by them.
HEDON_FN void integrate(const PhysicsScratch& scratch, const BatchRange& range, const SolverConstants& c) {
  for (int32_t index = range.first_index; index < range.last_index; ++index) {
    Motion motion = scratch.motion[index];
    motion.x = clamp(motion.x, -c.max_speed, c.max_speed);
    motion.y = clamp(motion.y, -c.max_speed, c.max_speed);
    motion.angular = clamp(motion.angular, -c.max_angular_speed, c.max_angular_speed);
    scratch.motion[index] = motion;
    scratch.position[index].x += motion.x * c.dt;
    scratch.position[index].y += motion.y * c.dt;
    scratch.angle[index] += motion.angular * c.dt;
  }
}

/// The solver by name `sequential`, for `try_batch`.
struct SequentialSolver {
  /// Damps velocities, finds contacts, solves, bounces, moves, and corrects overlaps.
  template <class Bodies, class Visitor>
  HEDON_FN static void substep(const Batch<Bodies>& batch, Visitor& visitor) {
    const PhysicsScratch& scratch = batch.scratch;
    const SolverConstants& c = batch.c;
    Motion* motion = scratch.motion.data;
    for (int32_t index = batch.range.first_index; index < batch.range.last_index; ++index) {
      motion[index].x *= c.linear_decay;
      motion[index].y *= c.linear_decay;
      motion[index].angular *= c.angular_decay;
    }
    const Array<Segment>& walls = batch.state.walls;
    const auto nearest = [&](int32_t wall, Vec2 center) {
      return nearest_on_segment(walls[wall].a, walls[wall].b, center);
    };
    const auto below = [](float touch) { return Reach{touch * touch, touch * touch}; };
    auto* bodies = batch.body_contacts();
    StaticContact* statics = batch.static_contacts();
    const FoundContacts body = find_in_colors(batch, visitor);
    const FoundContacts circle = find_circle_contacts(batch, below, statics, visitor);
    StaticContact* on_walls = statics + circle.count;
    const FoundContacts wall = find_wall_contacts(batch, below, on_walls, visitor, nearest);
    const int32_t static_count = circle.count + wall.count;

    warm_start(bodies, body.count, motion);
    warm_start(statics, static_count, motion);
    for (int32_t pass = 0; pass < batch.config.velocity_passes; ++pass) {
      solve_velocity(bodies, body.count, c, motion);
      solve_velocity(statics, static_count, c, motion);
    }
    if (body.fast) apply_restitution(bodies, body.count, c, motion);
    if (circle.fast || wall.fast) apply_restitution(statics, static_count, c, motion);
    keep_impulses(bodies, body.count, scratch.bodies);
    keep_impulses(statics, circle.count, scratch.circles);
    keep_impulses(on_walls, wall.count, scratch.walls);

    integrate(scratch, batch.range, c);
    for (int32_t pass = 0; pass < batch.config.position_passes; ++pass) {
      correct_positions(batch, bodies, body.count, scratch.position.data);
      correct_positions(statics, static_count, c, scratch.position.data);
    }
  }
};

}  // namespace hedon
