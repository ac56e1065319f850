/// Sequential impulses and position correction for the contacts of one batch and one substep.
///
/// Source: Catto (2005), "Iterative dynamics with temporal coherence"; the order of the parts is Box2D's. Since a
/// disc's friction does not change its normal velocity, both are found from the same velocities; friction is bounded
/// by the normal impulse of the pass before. Invariant of all of it: pairs of bodies keep their total momentum, to
/// float rounding.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/math.h"
#include "base/vec2.h"
#include "physics/body.h"
#include "physics/config.h"
#include "physics/contact.h"

namespace hedon {

/// What every substep needs, computed once per step.
struct SolverConstants {
  float dt;             ///< [s]
  float linear_decay;   ///< of velocities per substep
  float angular_decay;  ///< of angular velocities per substep
  float inverse_mass;
  float inverse_inertia;
  float inverse_gyration;       ///< mass / inertia [1/u²]
  float friction;               ///< coefficient
  float restitution;            ///< coefficient
  float restitution_threshold;  ///< approach speed from which contacts bounce [u/s]
  float correction_rate;
  float slop;               ///< overlap that is left alone [u]
  float max_correction;     ///< per pass [u]
  float max_speed;          ///< per axis [u/s]
  float max_angular_speed;  ///< [rad/s]
  float glide;              ///< free path in a step per speed after the force [s]
};

HEDON_FN SolverConstants make_constants(const PhysicsConfig& config, const BodyShape& shape) {
  SolverConstants c;
  c.dt = config.dt;
  c.linear_decay = static_cast<float>(exp_double(-static_cast<double>(config.linear_damping) * config.dt));
  c.angular_decay = static_cast<float>(exp_double(-static_cast<double>(config.angular_damping) * config.dt));
  c.inverse_mass = 1.0f / shape.mass;
  c.inverse_inertia = 1.0f / shape.inertia;
  c.inverse_gyration = shape.mass / shape.inertia;
  c.friction = config.friction;
  c.restitution = config.restitution;
  c.restitution_threshold = config.restitution_threshold;
  c.correction_rate = config.correction_rate;
  c.slop = config.slop;
  c.max_correction = config.max_correction;
  c.max_speed = config.max_speed;
  c.max_angular_speed = config.max_angular_speed;
  c.glide = 0.0f;
  float decay = 1.0f;
  for (int32_t substep = 0; substep < config.substeps; ++substep) {
    decay *= c.linear_decay;
    c.glide += c.dt * decay;
  }
  return c;
}

HEDON_FN float clamp(float value, float low, float high) {
  const float above = value < low ? low : value;
  return above > high ? high : above;
}

/// Velocity of the second body relative to the first at the contact, along normal and tangent (normal turned left).
struct ContactVelocity {
  float normal, tangent;  ///< [u/s]
};

HEDON_FN ContactVelocity relative_velocity(const BodyContact& contact, const Motion& a, const Motion& b) {
  const float x = b.x - a.x, y = b.y - a.y;
  return {x * contact.normal_x + y * contact.normal_y,
          (y * contact.normal_x - x * contact.normal_y) - contact.arm * (a.angular + b.angular)};
}

HEDON_FN ContactVelocity relative_velocity(const StaticContact& contact, const Motion& a) {
  return {-(a.x * contact.normal_x + a.y * contact.normal_y),
          (a.x * contact.normal_y - a.y * contact.normal_x) - contact.arm * a.angular};
}

/// Applies an impulse per mass to a pair: onto the second body, and its opposite onto the first.
HEDON_FN void apply(const BodyContact& contact, float normal, float tangent, Motion& a, Motion& b) {
  const float x = normal * contact.normal_x - tangent * contact.normal_y;
  const float y = normal * contact.normal_y + tangent * contact.normal_x;
  const float spin = contact.turn * tangent;
  a.x -= x;
  a.y -= y;
  a.angular -= spin;
  b.x += x;
  b.y += y;
  b.angular -= spin;
}

HEDON_FN void apply(const StaticContact& contact, float normal, float tangent, Motion& a) {
  a.x -= normal * contact.normal_x - tangent * contact.normal_y;
  a.y -= normal * contact.normal_y + tangent * contact.normal_x;
  a.angular -= contact.turn * tangent;
}

/// Effective mass along the normal, per mass of a body: a half for two equal bodies, one against what never moves.
HEDON_FN constexpr float normal_mass(const BodyContact&) { return 0.5f; }
HEDON_FN constexpr float normal_mass(const StaticContact&) { return 1.0f; }

/// Accumulates one solution of a contact; returns by how much the impulses changed.
template <class Contact>
HEDON_FN ContactVelocity accumulate(Contact& contact, const SolverConstants& c, ContactVelocity velocity) {
  const float limit = c.friction * contact.normal_impulse;
  const float tangent = clamp(contact.tangent_impulse - contact.tangent_mass * velocity.tangent, -limit, limit);
  const float pushed = contact.normal_impulse - normal_mass(contact) * velocity.normal;
  const float normal = pushed > 0.0f ? pushed : 0.0f;
  const ContactVelocity change{normal - contact.normal_impulse, tangent - contact.tangent_impulse};
  contact.normal_impulse = normal;
  contact.tangent_impulse = tangent;
  return change;
}

/// One pass of projected Gauss-Seidel over contacts between bodies.
HEDON_FN void solve_velocity(BodyContact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    BodyContact& contact = contacts[i];
    Motion &a = motion[contact.first], &b = motion[contact.second];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a, b));
    apply(contact, change.normal, change.tangent, a, b);
  }
}

/// One pass of projected Gauss-Seidel over contacts with what never moves.
HEDON_FN void solve_velocity(StaticContact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    StaticContact& contact = contacts[i];
    Motion& a = motion[contact.body];
    const ContactVelocity change = accumulate(contact, c, relative_velocity(contact, a));
    apply(contact, change.normal, change.tangent, a);
  }
}

/// Applies the impulses of the substep before.
HEDON_FN void warm_start(const BodyContact* contacts, int32_t count, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    const BodyContact& contact = contacts[i];
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.first], motion[contact.second]);
  }
}

HEDON_FN void warm_start(const StaticContact* contacts, int32_t count, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    const StaticContact& contact = contacts[i];
    apply(contact, contact.normal_impulse, contact.tangent_impulse, motion[contact.body]);
  }
}

/// Normal impulse per mass that makes a contact leave at `restitution` times its approach speed; 0 where it was slow
/// or no impulse acted.
template <class Contact>
HEDON_FN float bounce(Contact& contact, const SolverConstants& c, float normal_velocity) {
  if (!(contact.approach < -c.restitution_threshold) || !(contact.normal_impulse > 0.0f)) return 0.0f;
  const float wanted = normal_velocity + c.restitution * contact.approach;
  const float pushed = contact.normal_impulse - normal_mass(contact) * wanted;
  const float normal = pushed > 0.0f ? pushed : 0.0f;
  const float change = normal - contact.normal_impulse;
  contact.normal_impulse = normal;
  return change;
}

HEDON_FN void apply_restitution(BodyContact* contacts, int32_t count, const SolverConstants& c, Motion* motion) {
  for (int32_t i = 0; i < count; ++i) {
    BodyContact& contact = contacts[i];
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

/// How far one pass pushes a pair apart, as a negative length [u].
HEDON_FN float correction(const SolverConstants& c, float separation) {
  return clamp(c.correction_rate * (separation + c.slop), -c.max_correction, 0.0f);
}

/// One pass of position correction between bodies: each moves half the way. The separation is that of the present
/// places along the normal of the contact, which differs from the true one by less than the slop after a substep's
/// motion. `distance` is that of touching centers [u].
HEDON_FN void correct_positions(const BodyContact* contacts, int32_t count, const SolverConstants& c, float distance,
                                Vec2* position) {
  for (int32_t i = 0; i < count; ++i) {
    const BodyContact& contact = contacts[i];
    const Vec2 normal{contact.normal_x, contact.normal_y};
    const Vec2 a = position[contact.first], b = position[contact.second];
    const Vec2 push = (0.5f * correction(c, dot(b - a, normal) - distance)) * normal;
    position[contact.first] = a + push;
    position[contact.second] = b - push;
  }
}

/// One pass of position correction against what never moves.
HEDON_FN void correct_positions(const StaticContact* contacts, int32_t count, const SolverConstants& c,
                                Vec2* position) {
  for (int32_t i = 0; i < count; ++i) {
    const StaticContact& contact = contacts[i];
    const Vec2 normal{contact.normal_x, contact.normal_y}, anchor{contact.anchor_x, contact.anchor_y};
    const Vec2 a = position[contact.body];
    position[contact.body] = a + correction(c, dot(anchor - a, normal)) * normal;
  }
}

}  // namespace hedon
