/// Movable bodies, static circles and walls.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/math.h"
#include "base/vec2.h"

namespace hedon {

/// A disc of uniform density.
struct BodyShape {
  float radius;   ///< [u]
  float mass;     ///< π·radius²·density
  float inertia;  ///< about the center: ½·mass·radius² [mass·u²]

  HEDON_FIELDS(BodyShape, radius, mass, inertia)
};

HEDON_FN BodyShape make_disc(float radius, float density) {
  const float mass = density * PI_F * radius * radius;
  return {radius, mass, 0.5f * mass * radius * radius};
}

inline constexpr int MAX_BODY_CLASSES = 4;
inline constexpr int MAX_CIRCLE_CLASSES = 8;

/// Friction and restitution of a contact.
struct Material {
  float friction;     ///< coefficient
  float restitution;  ///< coefficient
};

/// The classes of bodies and of static circles. Each class owns a range of slots. Walls from `first_obstacle` on have
/// their own material.
struct BodyTable {
  int32_t classes;
  int32_t first_slot[MAX_BODY_CLASSES + 1];  ///< class c owns slots [first_slot[c], first_slot[c + 1])
  BodyShape shape[MAX_BODY_CLASSES];
  int32_t own;  ///< 1 if bodies have individual shapes, `PhysicsState::shape`, between these limits of their class:
  BodyShape smallest[MAX_BODY_CLASSES], largest[MAX_BODY_CLASSES];  ///< both equal to `shape` if they do not
  uint32_t meets_bodies[MAX_BODY_CLASSES];   ///< bit c: it collides with bodies of class c; symmetric
  uint32_t meets_circles[MAX_BODY_CLASSES];  ///< bit c: it collides with circles of class c
  int32_t circle_classes;
  int32_t first_circle[MAX_CIRCLE_CLASSES + 1];
  float circle_radius;  ///< of every static circle [u]
  int32_t first_obstacle;
  Material obstacle;

  HEDON_FN int32_t body_class(int32_t slot) const {
    int32_t c = 0;
    while (slot >= first_slot[c + 1]) ++c;
    return c;
  }
  HEDON_FN int32_t circle_class(int32_t circle) const {
    int32_t c = 0;
    while (circle >= first_circle[c + 1]) ++c;
    return c;
  }
  HEDON_FN bool collide(int32_t slot, int32_t other) const {
    return (meets_bodies[body_class(slot)] >> body_class(other) & 1u) != 0;
  }
  HEDON_FN bool collides_with_circle(int32_t slot, int32_t circle) const {
    return (meets_circles[body_class(slot)] >> circle_class(circle) & 1u) != 0;
  }
  HEDON_FN void set_shape(int32_t c, const BodyShape& of_class) { shape[c] = smallest[c] = largest[c] = of_class; }
  HEDON_FN float max_radius() const {
    float most = largest[0].radius;
    for (int32_t c = 1; c < classes; ++c) most = largest[c].radius > most ? largest[c].radius : most;
    return most;
  }
  HEDON_FN float min_radius() const {
    float least = smallest[0].radius;
    for (int32_t c = 1; c < classes; ++c) least = smallest[c].radius < least ? smallest[c].radius : least;
    return least;
  }
  HEDON_FN float min_mass() const {
    float least = smallest[0].mass;
    for (int32_t c = 1; c < classes; ++c) least = smallest[c].mass < least ? smallest[c].mass : least;
    return least;
  }
};

/// One class of bodies and one class of circles, all of which collide.
HEDON_FN BodyTable uniform_bodies(const BodyShape& shape, float circle_radius, int64_t slots, int64_t circles) {
  BodyTable table{};
  table.classes = table.circle_classes = 1;
  table.first_slot[1] = static_cast<int32_t>(slots);
  table.first_circle[1] = static_cast<int32_t>(circles);
  table.set_shape(0, shape);
  table.meets_bodies[0] = table.meets_circles[0] = 1;
  table.circle_radius = circle_radius;
  table.first_obstacle = INT32_MAX;
  return table;
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
