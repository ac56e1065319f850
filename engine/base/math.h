/// Elementary functions with the same bits on every machine: only IEEE + - * / sqrt and bit operations.
///
/// The C library's versions differ between systems, so a run could not be repeated on another one. All functions
/// compute in double and round once to float: relative error below 1e-7 over the stated ranges, tested against the C
/// library.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/device.h"

namespace hedon {

inline constexpr double PI = 3.14159265358979323846;
inline constexpr float PI_F = 3.14159265358979323846f;
inline constexpr float TWO_PI_F = 6.28318530717958647692f;
inline constexpr double LOG_10 = 2.30258509299404568402;

HEDON_FN double bits_to_double(uint64_t bits) {
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

HEDON_FN uint64_t double_to_bits(double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The integer nearest to x, |x| < 2^51: adding 1.5 · 2^52 leaves no bits for a fraction.
HEDON_FN double round_double(double x) {
  constexpr double SHIFT = 6755399441055744.0;
  return (x + SHIFT) - SHIFT;
}

/// e^x for any x; below -700 it is 0, above 700 it is e^700. Degree-11 Taylor polynomial on |r| <= ln(2)/2, with its
/// terms in pairs of pairs, so that they can be computed in parallel.
HEDON_FN double exp_double(double x) {
  if (x < -700.0) return 0.0;
  if (x > 700.0) x = 700.0;
  const double n = round_double(x * 1.4426950408889634074);
  const double r = (x - n * 0.69314718036912381649) - n * 1.9082149292705877e-10;
  const double r2 = r * r, r4 = r2 * r2;
  const double p0 = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
  const double p4 = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
  const double p8 = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
  const double p = p0 + r4 * (p4 + r4 * p8);
  return p * bits_to_double(static_cast<uint64_t>(static_cast<int64_t>(n) + 1023) << 52);
}

/// Natural logarithm of a positive, normal x, by the series of atanh around 1.
HEDON_FN double log_double(double x) {
  uint64_t bits = double_to_bits(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  double m = bits_to_double((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);
  if (m > 1.4142135623730950488) {
    m *= 0.5;
    exponent += 1;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double p = 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z + 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z + 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z + 1.0 / 3.0;
  p = p * z + 1.0;
  return exponent * 0.69314718055994530942 + 2.0 * s * p;
}

/// Sine and cosine of x [rad], |x| < 1e6.
HEDON_FN void sincos_double(double x, double* sine, double* cosine) {
  const double n = round_double(x * (2.0 / PI));
  const double r = (x - n * 1.57079632673412561417) - n * 6.07710050650619224932e-11;
  const double z = r * r;
  double s = 1.0 / 6227020800.0;
  s = s * z - 1.0 / 39916800.0;
  s = s * z + 1.0 / 362880.0;
  s = s * z - 1.0 / 5040.0;
  s = s * z + 1.0 / 120.0;
  s = s * z - 1.0 / 6.0;
  s = s * z * r + r;
  double c = 1.0 / 479001600.0;
  c = c * z - 1.0 / 3628800.0;
  c = c * z + 1.0 / 40320.0;
  c = c * z - 1.0 / 720.0;
  c = c * z + 1.0 / 24.0;
  c = c * z - 0.5;
  c = c * z + 1.0;
  switch (static_cast<int64_t>(n) & 3) {
    case 0:
      *sine = s;
      *cosine = c;
      break;
    case 1:
      *sine = c;
      *cosine = -s;
      break;
    case 2:
      *sine = -s;
      *cosine = -c;
      break;
    default:
      *sine = -c;
      *cosine = s;
      break;
  }
}

/// The angle of (x, y) to the x axis, in [-π, π]; 0 for (0, 0). Three times it halves the angle, whose tangent then has
/// a short series.
HEDON_FN double atan2_double(double y, double x) {
  const double longer = fabs(x) > fabs(y) ? fabs(x) : fabs(y);
  if (!(longer > 0.0)) return 0.0;
  double t = (fabs(x) > fabs(y) ? fabs(y) : fabs(x)) / longer;
  for (int32_t half = 0; half < 3; ++half) t = t / (1.0 + sqrt(1.0 + t * t));
  const double z = t * t;
  double p = 1.0 / 17.0;
  p = 1.0 / 15.0 - p * z;
  p = 1.0 / 13.0 - p * z;
  p = 1.0 / 11.0 - p * z;
  p = 1.0 / 9.0 - p * z;
  p = 1.0 / 7.0 - p * z;
  p = 1.0 / 5.0 - p * z;
  p = 1.0 / 3.0 - p * z;
  double angle = 8.0 * (t - t * z * p);
  if (fabs(y) > fabs(x)) angle = 0.5 * PI - angle;
  if (x < 0.0) angle = PI - angle;
  return y < 0.0 ? -angle : angle;
}

HEDON_FN float exp_float(float x) { return static_cast<float>(exp_double(x)); }
HEDON_FN float log_float(float x) { return static_cast<float>(log_double(x)); }
HEDON_FN float sigmoid(float x) { return static_cast<float>(1.0 / (1.0 + exp_double(-static_cast<double>(x)))); }

HEDON_FN void sincos_float(float x, float* sine, float* cosine) {
  double s, c;
  sincos_double(x, &s, &c);
  *sine = static_cast<float>(s);
  *cosine = static_cast<float>(c);
}

/// Wraps an angle [rad] into [0, 2π).
HEDON_FN float wrap_angle(float angle) {
  if (angle < -TWO_PI_F || angle >= 2.0f * TWO_PI_F) angle -= TWO_PI_F * floorf(angle / TWO_PI_F);
  if (angle < 0.0f) angle += TWO_PI_F;
  if (angle >= TWO_PI_F) angle -= TWO_PI_F;
  return angle < 0.0f ? 0.0f : angle;
}

HEDON_FN bool is_finite(double value) { return value - value == 0.0; }

}  // namespace hedon
