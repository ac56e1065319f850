/// Elementary functions over lanes. Include after one of the lane types: `Lanes` is that type.
#pragma once

#include "lanes/unroll.h"

namespace hedon {
namespace {

/// tanh, absolute error below 5e-7. A rational function x·P(x²)/Q(x²), fitted for the smallest maximal error on
/// [0, 7.8]; above that it keeps its last value, 1 - 3e-7. NaN stays NaN.
HEDON_INLINE Lanes tanh_lanes(Lanes x) {
  x = larger(broadcast(-7.8f), smaller(broadcast(7.8f), x));
  const Lanes z = x * x;
  Lanes p = multiply_add(z, broadcast(0x1.099730p-26f), broadcast(0x1.71a964p-16f));
  Lanes q = multiply_add(z, broadcast(0x1.ce1fdcp-21f), broadcast(0x1.670f68p-12f));
  p = multiply_add(z, p, broadcast(0x1.d521e0p-9f));
  q = multiply_add(z, q, broadcast(0x1.ad23d8p-6f));
  p = multiply_add(z, p, broadcast(0x1.13783ep-3f));
  q = multiply_add(z, q, broadcast(0x1.df116ep-2f));
  p = multiply_add(z, p, broadcast(1.0f));
  q = multiply_add(z, q, broadcast(1.0f));
  return x * p / q;
}

/// e^x, relative error below 3e-7, for x clamped to [-87, 88]. NaN stays NaN. Taylor polynomial on |r| <= ln(2)/2.
HEDON_INLINE Lanes exp_lanes(Lanes x) {
  x = larger(broadcast(-87.0f), smaller(broadcast(88.0f), x));
  const Lanes shift = broadcast(12582912.0f);  // 1.5 * 2^23: adding it rounds to an integer
  const Lanes shifted = multiply_add(x, broadcast(1.44269504f), shift);
  const Lanes n = shifted - shift;
  const Lanes r = multiply_add(n, broadcast(2.12194440e-4f), multiply_add(n, broadcast(-0.693359375f), x));
  Lanes p = multiply_add(r, broadcast(1.0f / 5040.0f), broadcast(1.0f / 720.0f));
  p = multiply_add(r, p, broadcast(1.0f / 120.0f));
  p = multiply_add(r, p, broadcast(1.0f / 24.0f));
  p = multiply_add(r, p, broadcast(1.0f / 6.0f));
  p = multiply_add(r, p, broadcast(0.5f));
  p = multiply_add(r, p, broadcast(1.0f));
  p = multiply_add(r, p, broadcast(1.0f));
  return p * scale_exponent(broadcast(1.0f), shifted);  // a product, so that NaN stays NaN
}

}  // namespace
}  // namespace hedon
