/// Sequential impulses and position correction for the contacts of one batch and one substep.
///
/// Source: Catto (2005), "Iterative dynamics with temporal coherence"; the order of the parts is Box2D's. Since a
/// disc's friction does not change its normal velocity, both are computed from the same velocities. The normal impulse
/// of the pass before limits friction. Invariant: every pair of bodies keeps its total momentum, up to float rounding.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "physics/detect.h"
#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

/// The contacts of a batch between bodies, in the order of colors.
template <class Contact>
struct ColoredContacts {
  Contact* contact;
  const int32_t* color_start;
  int32_t count;
  bool fast;  ///< whether any approaches so fast that it may bounce

  /// Calls body(contact) for each.
  template <class Crew, class Body>
  HEDON_FN void each(const Crew& crew, Body&& body) const {
    crew.each_by_group(color_start, count, COLORS - 1, [&](int32_t i) { body(contact[i]); });
  }
};

/// Gives each of the first `count` active pairs a color, in their order, and a number within it.
/// start   becomes the first contact of each color
HEDON_FN void give_colors(const PairList& pairs, const PhysicsScratch& scratch, const int32_t* active, int32_t* color,
                          int32_t count, int32_t* start) {
  uint32_t* colors = scratch.colors.data;
  for (int32_t i = 0; i < count; ++i) {
    uint32_t& a = colors[pairs.first[active[i]]];
    uint32_t& b = colors[pairs.second[active[i]]];
    // The last color takes all remaining contacts; they may share bodies, which only costs time.
    const int taken = lowest_bit(~(a | b) | 0x80000000u);
    a |= 1u << taken;
    b |= 1u << taken;
    color[i] = start[taken]++ * COLORS + taken;
  }
  int32_t sum = 0, taken = 0;
  for (; sum < count; ++taken) {
    const int32_t size = start[taken];
    start[taken] = sum;
    sum += size;
  }
  start[taken] = count;
}

/// Finds the contacts of a batch between bodies, in the order of colors: no two of one color share a body, so that
/// consecutive contacts do not wait for one another. Only overlapping pairs get a color, in canonical order. So the
/// order of two contacts that share a body depends only on the contacts of their own cluster. A pair that does not
/// overlap loses its impulses. Contacts are written from `first_body_pair` on. Each contact is reported to the visitor
/// twice, once for each body.
template <class Bodies, class Crew, class Visitor>
HEDON_FN ColoredContacts<typename Bodies::Contact> find_in_colors(const Batch<Bodies, Crew>& batch, Visitor& visitor) {
  const PairList& pairs = batch.state.neighbors.bodies;
  const PhysicsScratch& scratch = batch.scratch;
  const BatchRange& range = batch.range;
  const Crew& crew = batch.crew;
  const int32_t* first = pairs.first.data;
  const int32_t* second = pairs.second.data;
  float* normal_impulse = scratch.bodies.normal.data;
  float* tangent_impulse = scratch.bodies.tangent.data;
  const Vec2* position = scratch.position.data;
  const Bodies bodies = batch.bodies;
  const auto touches = [&](int32_t pair) {
    const float touch = bodies.radius(first[pair]) + bodies.radius(second[pair]);
    const bool touching = squared_length(position[second[pair]] - position[first[pair]]) < touch * touch;
    normal_impulse[pair] = touching ? normal_impulse[pair] : 0.0f;
    tangent_impulse[pair] = touching ? tangent_impulse[pair] : 0.0f;
    return touching;
  };
  int32_t* active = scratch.active.data + range.first_body_pair;
  const int32_t count = crew.select(range.first_body_pair, range.last_body_pair, touches,
                                    [&](int32_t at, int32_t pair) { active[at] = pair; });
  int32_t* start = batch.color_start();
  auto* contacts = batch.body_contacts();
  if (count == 0) return {contacts, start, 0, false};

  int32_t* color = scratch.color.data + range.first_body_pair;
  batch.each_body([&](int32_t index) { scratch.colors[index] = 0; });
  crew.each(0, COLORS, [&](int32_t taken) { start[taken] = 0; });
  crew.once([&] { give_colors(pairs, scratch, active, color, count, start); });
  bool fast = false;
  crew.each(0, count, [&](int32_t i) {
    const int32_t pair = active[i];
    auto& contact = contacts[start[color[i] % COLORS] + color[i] / COLORS];
    const Direction normal = direction_of(position[second[pair]] - position[first[pair]]);
    fill_contact(batch, pair, normal, contact);
    fast |= contact.approach < -batch.c.restitution_threshold;
    tell_bodies(batch, pair, {normal.x, normal.y}, visitor);
  });
  return {contacts, start, count, crew.any(fast)};
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
template <class Crew, class Contact>
HEDON_FN void solve_velocity(const Crew& crew, const ColoredContacts<Contact>& found, const SolverConstants& c,
                             Motion* motion) {
  found.each(crew, [&](Contact& contact) {
    Motion &a = motion[contact.first], &b = motion[contact.second];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a, b));
    apply(contact, change.normal, change.tangent, a, b);
  });
}

/// One pass of projected Gauss-Seidel over contacts with static objects.
template <class Crew>
HEDON_FN void solve_velocity(const Crew& crew, const StaticContacts& found, const SolverConstants& c, Motion* motion) {
  found.each(crew, [&](StaticContact& contact) {
    Motion& a = motion[contact.body];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a));
    apply(contact, change.normal, change.tangent, a);
  });
}

/// Applies the impulses of the previous substep.
template <class Crew, class Contact>
HEDON_FN void warm_start(const Crew& crew, const ColoredContacts<Contact>& found, Motion* motion) {
  found.each(crew, [&](const Contact& contact) {
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.first], motion[contact.second]);
  });
}

template <class Crew>
HEDON_FN void warm_start(const Crew& crew, const StaticContacts& found, Motion* motion) {
  found.each(crew, [&](const StaticContact& contact) {
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.body]);
  });
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

template <class Crew, class Contact>
HEDON_FN void apply_restitution(const Crew& crew, const ColoredContacts<Contact>& found, const SolverConstants& c,
                                Motion* motion) {
  found.each(crew, [&](Contact& contact) {
    Motion &a = motion[contact.first], &b = motion[contact.second];
    const float change = bounce(contact, c, relative_velocity(contact, a, b).normal);
    if (change != 0.0f) apply(contact, change, 0.0f, a, b);
  });
}

template <class Crew>
HEDON_FN void apply_restitution(const Crew& crew, const StaticContacts& found, const SolverConstants& c,
                                Motion* motion) {
  found.each(crew, [&](StaticContact& contact) {
    Motion& a = motion[contact.body];
    const float change = bounce(contact, c, relative_velocity(contact, a).normal);
    if (change != 0.0f) apply(contact, change, 0.0f, a);
  });
}

/// One pass of position correction between bodies: of two equal ones, each moves half the distance. The separation is
/// measured between the present positions along the normal of the contact; after the motion of one substep it differs
/// from the true one by less than the slop.
template <class Bodies, class Crew, class Contact>
HEDON_FN void correct_positions(const Batch<Bodies, Crew>& batch, const ColoredContacts<Contact>& found,
                                Vec2* position) {
  found.each(batch.crew, [&](const Contact& contact) {
    const float touch = batch.body_touch(contact.first, contact.second);
    const Vec2 normal{contact.normal_x, contact.normal_y};
    const Vec2 a = position[contact.first], b = position[contact.second];
    const float push = correction(batch.c, dot(b - a, normal) - touch);
    const Shares share = shares(contact);
    position[contact.first] = a + (share.first * push) * normal;
    position[contact.second] = b - (share.second * push) * normal;
  });
}

/// One pass of position correction against static objects.
template <class Bodies, class Crew>
HEDON_FN void correct_positions(const Batch<Bodies, Crew>& batch, const StaticContacts& found, Vec2* position) {
  found.each(batch.crew, [&](const StaticContact& contact) {
    const Vec2 normal{contact.normal_x, contact.normal_y}, anchor{contact.anchor_x, contact.anchor_y};
    const Vec2 a = position[contact.body];
    position[contact.body] = a + correction(batch.c, dot(anchor - a, normal)) * normal;
  });
}

/// Limits the velocities and moves the bodies by them.
template <class Bodies, class Crew>
HEDON_FN void integrate(const Batch<Bodies, Crew>& batch) {
  const PhysicsScratch& scratch = batch.scratch;
  const SolverConstants& c = batch.c;
  batch.each_body([&](int32_t index) {
    Motion motion = scratch.motion[index];
    motion.x = clamp(motion.x, -c.max_speed, c.max_speed);
    motion.y = clamp(motion.y, -c.max_speed, c.max_speed);
    motion.angular = clamp(motion.angular, -c.max_angular_speed, c.max_angular_speed);
    scratch.motion[index] = motion;
    scratch.position[index].x += motion.x * c.dt;
    scratch.position[index].y += motion.y * c.dt;
    scratch.angle[index] += motion.angular * c.dt;
  });
}

/// The solver by name `sequential`, for `try_batch`.
struct SequentialSolver {
  /// Damps velocities, finds contacts, solves, bounces, moves, and corrects overlaps.
  template <class Bodies, class Crew, class Visitor>
  HEDON_FN static void substep(const Batch<Bodies, Crew>& batch, Visitor& visitor) {
    const SolverConstants& c = batch.c;
    const Crew& crew = batch.crew;
    Motion* motion = batch.scratch.motion.data;
    Vec2* position = batch.scratch.position.data;
    batch.each_body([&](int32_t index) {
      motion[index].x *= c.linear_decay;
      motion[index].y *= c.linear_decay;
      motion[index].angular *= c.angular_decay;
    });
    const Array<Segment>& walls = batch.state.walls;
    const auto nearest = [&](int32_t wall, Vec2 center) {
      return nearest_on_segment(walls[wall].a, walls[wall].b, center);
    };
    const auto below = [](float touch) { return Reach{touch * touch, touch * touch}; };
    const auto bodies = find_in_colors(batch, visitor);
    const StaticContacts statics = find_static_contacts(batch, below, visitor, nearest);

    warm_start(crew, bodies, motion);
    warm_start(crew, statics, motion);
    for (int32_t pass = 0; pass < batch.config.velocity_passes; ++pass) {
      solve_velocity(crew, bodies, c, motion);
      solve_velocity(crew, statics, c, motion);
    }
    if (bodies.fast) apply_restitution(crew, bodies, c, motion);
    if (statics.fast) apply_restitution(crew, statics, c, motion);
    keep_impulses(batch, bodies.contact, bodies.count);
    keep_impulses(batch, statics);

    integrate(batch);
    for (int32_t pass = 0; pass < batch.config.position_passes; ++pass) {
      correct_positions(batch, bodies, position);
      correct_positions(batch, statics, position);
    }
  }
};

}  // namespace hedon
