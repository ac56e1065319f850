/// From senses to forces: the observation, the policy, its sample, and the motors.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "world/sensor.h"
#include "world/world.h"

namespace hedon {

inline constexpr float LOG_SQRT_TWO_PI = 0.91893853320467274178f;

/// Samples an action for the agent in `slot` and keeps it with its log-probability and the state's value.
HEDON_FN void sample_action(World& world, int32_t slot, int64_t t, const PackedObservation& observation) {
  const WorldState& state = world.state;
  const NetworkShape& network = world.species(slot).network;
  float output[16];
  world.kernel->forward(network, world.network(slot), observation, output);
  const RandomStream random{world.seed, Purpose::action, static_cast<uint32_t>(state.life[slot].agent_id),
                            static_cast<uint32_t>(world.head().step)};
  const Random4 bits = random.draw(0);
  const NormalPair noise = to_normal(bits.word[0], bits.word[1]);
  const float z[ACTIONS] = {noise.first, noise.second};
  const float* log_sd = world.params(slot) + network.log_sd();
  const int64_t row = slot * int64_t{world.shape->steps} + t;
  float log_prob = 0.0f;
  for (int a = 0; a < ACTIONS; ++a) {
    state.action[row * ACTIONS + a] = output[a] + exp_float(log_sd[a]) * z[a];
    log_prob += -0.5f * z[a] * z[a] - log_sd[a] - LOG_SQRT_TWO_PI;
  }
  state.log_prob[row] = log_prob;
  state.value[row] = output[ACTIONS];
}

/// Turns the action into the forces of the two motors, and the force and torque on the body.
HEDON_FN void apply_motors(World& world, int32_t slot, int64_t t) {
  const Species& species = world.species(slot);
  const MotorConfig& motor = species.config->motor;
  StepScratch& scratch = world.scratch;
  const float* action = &world.state.action[(slot * int64_t{world.shape->steps} + t) * ACTIONS];
  const float range = motor.max_force - motor.min_force;
  const float left = motor.min_force + range * sigmoid(action[0]);
  const float right = motor.min_force + range * sigmoid(action[1]);
  const float sine = scratch.heading_sine[slot], cosine = scratch.heading_cosine[slot];
  scratch.force_left[slot] = left;
  scratch.force_right[slot] = right;
  scratch.force_x[slot] = -sine * (left + right);
  scratch.force_y[slot] = cosine * (left + right);
  scratch.torque[slot] = species.motor_arm * (right - left);
}

/// All agents observe and act. A team goes through the agents in turn forward and backward: what it read last in one
/// step, it reads first in the next, while it is still in the cache.
template <class Group>
HEDON_FN void sense_and_act(Group& group, World& world, int64_t t) {
  const auto one = [&](int32_t i) {
    const int32_t slot = world.scratch.by_slot[i];
    note_start(world, slot);
    PackedObservation& observation = world.observation(slot, t);
    observe(world, slot, group.rank(), observation);
    sample_action(world, slot, t, observation);
    apply_motors(world, slot, t);
  };
  if (t % 2 == 0)
    group.for_each(world.head().living_count, one);
  else
    group.for_each_backward(world.head().living_count, one);
}

}  // namespace hedon
