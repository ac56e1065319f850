/// Movable bodies, static circles and walls.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/math.h"
#include "base/vec2.h"

namespace hedon {

/// The shape of all movable bodies, and the shape of all static circles.
struct BodyShape {
  float radius;         ///< of a movable body [u]
  float mass;           ///< of a movable body
  float inertia;        ///< of a movable body about its center [mass·u²]
  float circle_radius;  ///< of a static circle [u]

  HEDON_FIELDS(BodyShape, radius, mass, inertia, circle_radius)
};

/// A disc of uniform density (mass π·radius²·density, inertia ½·mass·radius²), and static circles of `circle_radius`.
HEDON_FN BodyShape make_disc(float radius, float density, float circle_radius) {
  const float mass = density * PI_F * radius * radius;
  return {radius, mass, 0.5f * mass * radius * radius, circle_radius};
}

/// Movable bodies by slot. Heading 0 points along +y; positive is counter-clockwise.
struct BodyState {
  Array<float> x;                 ///< center [u]
  Array<float> y;                 ///< center [u]
  Array<float> angle;             ///< in [0, 2π) between steps [rad]
  Array<float> velocity_x;        ///< [u/s]
  Array<float> velocity_y;        ///< [u/s]
  Array<float> angular_velocity;  ///< [rad/s]

  HEDON_FIELDS(BodyState, x, y, angle, velocity_x, velocity_y, angular_velocity)
};

/// Force and torque on each body during the first substep of a step, by slot.
struct BodyForce {
  Array<float> x;       ///< [mass·u/s²]
  Array<float> y;       ///< [mass·u/s²]
  Array<float> torque;  ///< about the center [mass·u²/s²]

  HEDON_FIELDS(BodyForce, x, y, torque)
};

/// Circles that never move, by slot.
struct StaticCircles {
  Array<float> x;          ///< center [u]
  Array<float> y;          ///< center [u]
  Array<uint8_t> present;  ///< 1 where the slot holds a circle

  HEDON_FIELDS(StaticCircles, x, y, present)
};

/// A wall: a segment without thickness, solid on both sides.
struct Segment {
  Vec2 a, b;  ///< [u]

  HEDON_FIELDS(Segment, a, b)
};

}  // namespace hedon
