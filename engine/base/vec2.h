/// Two-dimensional vectors of float [u].
#pragma once

#include <cmath>

#include "base/device.h"

namespace hedon {

struct Vec2 {
  float x, y;
};

HEDON_FN Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
HEDON_FN Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
HEDON_FN Vec2 operator*(float s, Vec2 a) { return {s * a.x, s * a.y}; }
HEDON_FN Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
HEDON_FN float dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
HEDON_FN float cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
/// Velocity of a point at `r` from the center of a body that rotates at `omega` [rad/s].
HEDON_FN Vec2 cross(float omega, Vec2 r) { return {-omega * r.y, omega * r.x}; }
HEDON_FN float squared_length(Vec2 a) { return dot(a, a); }
HEDON_FN float length(Vec2 a) { return sqrtf(dot(a, a)); }

/// Point of the segment from `a` to `b` that is nearest to `p`; for a segment without length, its first end.
HEDON_FN Vec2 nearest_on_segment(Vec2 a, Vec2 b, Vec2 p) {
  const Vec2 along = b - a;
  const float squared = dot(along, along);
  float t = squared > 0.0f ? dot(p - a, along) / squared : 0.0f;
  t = t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
  return a + t * along;
}

}  // namespace hedon
