/// Code for both contact solvers: constants, velocities at a contact, and the effect of an impulse on its bodies.
#pragma once

#include <cstdint>

#include "base/math.h"
#include "base/vec2.h"
#include "config/schema.h"
#include "physics/body.h"
#include "physics/contact.h"
#include "physics/state.h"

namespace hedon {

/// Constants of all substeps, computed once per step.
struct SolverConstants {
  float dt;                     ///< [s]
  float linear_decay;           ///< of velocities per substep
  float angular_decay;          ///< of angular velocities per substep
  float friction;               ///< coefficient
  float restitution;            ///< coefficient
  float restitution_threshold;  ///< approach speed from which contacts bounce [u/s]
  float correction_rate;
  float slop;               ///< overlap that is not corrected [u]
  float max_correction;     ///< per pass [u]
  float max_speed;          ///< per axis [u/s]
  float max_angular_speed;  ///< [rad/s]
  float glide;              ///< distance moved in a step without contacts, per speed after the force [s]
};

HEDON_FN SolverConstants make_constants(const PhysicsConfig& config) {
  SolverConstants c;
  c.dt = config.dt;
  c.linear_decay = static_cast<float>(exp_double(-static_cast<double>(config.linear_damping) * config.dt));
  c.angular_decay = static_cast<float>(exp_double(-static_cast<double>(config.angular_damping) * config.dt));
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

HEDON_FN ContactVelocity relative_velocity(const MixedContact& contact, const Motion& a, const Motion& b) {
  const float x = b.x - a.x, y = b.y - a.y;
  return {
      x * contact.normal_x + y * contact.normal_y,
      (y * contact.normal_x - x * contact.normal_y) - (contact.arm_first * a.angular + contact.arm_second * b.angular)};
}

HEDON_FN ContactVelocity relative_velocity(const StaticContact& contact, const Motion& a) {
  return {-(a.x * contact.normal_x + a.y * contact.normal_y),
          (a.x * contact.normal_y - a.y * contact.normal_x) - contact.arm * a.angular};
}

/// Applies an impulse per mass to the second body of a pair, and the opposite impulse to the first.
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

HEDON_FN void apply(const MixedContact& contact, float normal, float tangent, Motion& a, Motion& b) {
  const float x = normal * contact.normal_x - tangent * contact.normal_y;
  const float y = normal * contact.normal_y + tangent * contact.normal_x;
  a.x -= contact.weight_first * x;
  a.y -= contact.weight_first * y;
  a.angular -= contact.turn_first * tangent;
  b.x += contact.weight_second * x;
  b.y += contact.weight_second * y;
  b.angular -= contact.turn_second * tangent;
}

HEDON_FN void apply(const StaticContact& contact, float normal, float tangent, Motion& a) {
  a.x -= normal * contact.normal_x - tangent * contact.normal_y;
  a.y -= normal * contact.normal_y + tangent * contact.normal_x;
  a.angular -= contact.turn * tangent;
}

/// Effective mass along the normal, per mass: a half for two equal bodies, one against a static object.
HEDON_FN constexpr float normal_mass(const BodyContact&) { return 0.5f; }
HEDON_FN float normal_mass(const MixedContact& contact) { return contact.normal_mass; }
HEDON_FN constexpr float normal_mass(const StaticContact&) { return 1.0f; }

/// Friction and restitution of a contact, in which only static objects differ.
template <class Contact>
HEDON_FN Material material(const Contact&, const SolverConstants& c) {
  return {c.friction, c.restitution};
}
HEDON_FN Material material(const StaticContact& contact, const SolverConstants&) {
  return {contact.friction, contact.restitution};
}

/// Share of a position correction that each body moves.
struct Shares {
  float first, second;
};
HEDON_FN constexpr Shares shares(const BodyContact&) { return {0.5f, 0.5f}; }
HEDON_FN Shares shares(const MixedContact& contact) {
  return {contact.weight_first * contact.normal_mass, contact.weight_second * contact.normal_mass};
}

/// Distance by which one pass separates a pair, as a negative length [u].
HEDON_FN float correction(const SolverConstants& c, float separation) {
  return clamp(c.correction_rate * (separation + c.slop), -c.max_correction, 0.0f);
}

/// Stores the accumulated impulses of a contact for the next substep.
template <class Contact>
HEDON_FN void keep_impulse(const Contact& contact, const PairScratch& work) {
  work.normal[contact.pair] = contact.normal_impulse;
  work.tangent[contact.pair] = contact.tangent_impulse;
}

}  // namespace hedon
