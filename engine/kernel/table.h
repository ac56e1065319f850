/// Puts the kernels of one unit into its table. Include it after the unit's lane type.
#pragma once

#include "kernel/calibrate.h"
#include "kernel/cast_rays.h"
#include "kernel/cull_circles.h"
#include "kernel/kernel.h"
#include "kernel/network_forward.h"
#include "kernel/ppo_update.h"

namespace hedon {
namespace {

template <class Shape>
HEDON_FN constexpr Kernel make_table(const char* name) {
  return {name,
          {pack_weights, forward<Shape>, gradient_of_minibatch<Shape>, adam, update<Shape>},
          {cull_circles, cast_rays},
          {multiply_adds<Shape>, sum_floats}};
}

}  // namespace
}  // namespace hedon
