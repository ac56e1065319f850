/// From senses to forces: the observation, the policy, its sample, and the motors.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "base/random.h"
#include "world/sensor.h"
#include "world/store.h"
#include "world/world.h"

namespace hedon {

inline constexpr float LOG_SQRT_TWO_PI = 0.91893853320467274178f;

/// Two standard normals for the action of the agent in `slot` in this step.
HEDON_FN NormalPair action_noise(const World& world, int32_t slot) {
  const RandomStream random{world.seed, Purpose::action, static_cast<uint32_t>(world.state.life[slot].agent_id),
                            static_cast<uint32_t>(world.head().step)};
  const Random4 bits = random.draw(0);
  return to_normal(bits.word[0], bits.word[1]);
}

/// Samples an action for the agent in `slot` and stores it with its log-probability and the state's value.
/// output   of its network
HEDON_FN void sample_action(World& world, int32_t slot, int64_t t, const float* output) {
  const WorldState& state = world.state;
  const NetworkShape& network = world.species(slot).network;
  const NormalPair noise = action_noise(world, slot);
  const float z[ACTIONS] = {noise.first, noise.second};
  const float* log_sd = world.params(slot) + network.log_sd();
  const int64_t row = slot * int64_t{world.shape->rollout} + t;
  float log_prob = 0.0f;
  for (int a = 0; a < ACTIONS; ++a) {
    state.action[row * ACTIONS + a] = output[a] + exp_float(log_sd[a]) * z[a];
    log_prob += -0.5f * z[a] * z[a] - log_sd[a] - LOG_SQRT_TWO_PI;
  }
  state.log_prob[row] = log_prob;
  state.value[row] = output[ACTIONS];
}

/// Writes the action of the agent in `slot` to row `t` of its rollout, if its species has no networks.
HEDON_FN void act_without_network(World& world, int32_t slot, int64_t t) {
  float* action = &world.state.action[(slot * int64_t{world.shape->rollout} + t) * ACTIONS];
  switch (world.species(slot).config.learning.policy) {
    case LearningPolicy::random: {
      const NormalPair noise = action_noise(world, slot);
      action[0] = noise.first;
      action[1] = noise.second;
      return;
    }
    case LearningPolicy::external:
      for (int a = 0; a < ACTIONS; ++a) action[a] = world.state.external_action[int64_t{slot} * ACTIONS + a];
      return;
    case LearningPolicy::ppo:
    case LearningPolicy::fixed:
    case LearningPolicy::idle:
      return;
  }
}

/// Writes the action of the agent in `slot` to row `t` of its rollout, according to the policy of its species.
HEDON_FN void choose_action(World& world, int32_t slot, int64_t t) {
  if (!world.species(slot).has_network) return act_without_network(world, slot, t);
  float output[16];
  world.kernel->network.forward(world.species(slot).network, world.network(slot), world.observation(slot, t), output);
  sample_action(world, slot, t, output);
}

/// Turns the action into the forces of the two motors, and the force and torque on the body.
HEDON_FN void apply_motors(World& world, int32_t slot, int64_t t) {
  const Species& species = world.species(slot);
  const SpeciesLayout& motor = species.layout;
  StepScratch& scratch = world.scratch;
  const float* action = &world.state.action[(slot * int64_t{world.shape->rollout} + t) * ACTIONS];
  const bool rests = species.config.learning.policy == LearningPolicy::idle;
  const float range = motor.max_force - motor.min_force;
  float left = rests ? 0.0f : motor.min_force + range * sigmoid(action[0]);
  float right = rests ? 0.0f : motor.min_force + range * sigmoid(action[1]);
  for (int32_t i = 0; i < species.stores(); ++i) {
    const float threshold = store_of(species.config, i).motor_threshold;
    if (!(threshold > 0.0f)) continue;
    const float left_over = static_cast<float>(strength(threshold, world.held(slot, i)));
    left *= left_over;
    right *= left_over;
  }
  const float sine = scratch.heading_sine[slot], cosine = scratch.heading_cosine[slot];
  scratch.force_left[slot] = left;
  scratch.force_right[slot] = right;
  scratch.force_x[slot] = -sine * (left + right);
  scratch.force_y[slot] = cosine * (left + right);
  scratch.torque[slot] = species.motor_arm * (right - left);
}

/// All agents observe and act. A team processes the agents alternately forward and backward, so that the data read last
/// in one step is read first in the next, while it is still in the cache.
template <class Group>
HEDON_FN void sense_and_act(Group& group, World& world, int64_t t) {
  const auto one = [&](int32_t i) {
    const int32_t slot = world.scratch.by_slot[i];
    const int64_t row = world.kept(slot, t);
    note_start(world, slot);
    if (world.species(slot).observes) observe(world, slot, group.rank(), world.observation(slot, row));
    choose_action(world, slot, row);
    apply_motors(world, slot, row);
  };
  if (t % 2 == 0)
    group.for_each(world.head().living_count, one);
  else
    group.for_each_backward(world.head().living_count, one);
}

}  // namespace hedon
