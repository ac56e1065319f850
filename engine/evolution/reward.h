/// The inherited reward of one step.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "evolution/config.h"
#include "evolution/genome.h"

namespace hedon {

/// r = sum over kinds of w_k n_k + c_act w_act |f| / |f|_max.
/// eaten      foods of each kind eaten in this step (kinds)
/// force      Euclidean norm of the two applied forces
/// max_force  the norm of both motors at full force; not used if the action is not normalized
HEDON_FN float reward(const GenomeShape& shape, const RewardConfig& config, const float* genome, const int32_t* eaten,
                      float force, float max_force) {
  float sum = 0.0f;
  for (int32_t k = 0; k < shape.kinds; ++k) sum += genome[k] * static_cast<float>(eaten[k]);
  const float action = config.action_norm == ActionNorm::max_force ? force / max_force : force;
  return sum + config.action_coef * genome[shape.action()] * action;
}

}  // namespace hedon
