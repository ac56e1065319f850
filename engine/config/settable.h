/// The numbers of a species that genes may set, as `src/hedon/config/expression.py` finds them.
/// This file is written by `uv run python -m hedon.config.settable > engine/config/settable.h`. Do not edit it.
// clang-format off
#pragma once

#include <cstdint>

#include "base/device.h"
#include "config/schema.h"

namespace hedon {

HEDON_ENUM(GenomeSet, body_radius,
      body_density,
      motor_force_scale,
      motor_angle,
      sensor_ray_spread,
      sensor_ray_length,
      sensor_smell_decay,
      sensor_nose_angle,
      sensor_mouth_spread,
      sensor_mouth_center,
      store_capacity,
      store_basic_cost,
      store_action_cost,
      store_decay,
      store_child_share,
      store_hazard_weight,
      store_birth_weight,
      store_motor_threshold,
      hazard_kappa,
      hazard_alpha_energy,
      hazard_beta_energy,
      hazard_alpha_age,
      hazard_beta_age,
      birth_kappa,
      birth_beta,
      birth_logit_offset,
      birth_distance_sd,
      birth_network_noise,
      birth_mating_range,
      reward_drive_exponent,
      reward_drive_root)

/// A number that a gene sets, with its limits.
struct SettableNumber {
  float* number;
  float low, high;
};

/// Where a species has the number that genes of this name set; what is converted has no such place.
HEDON_FN SettableNumber settable(SpeciesConfig& config, GenomeSet which, int32_t store) {
  StoreConfig& own = store == 0 ? config.energy : config.store.items[store - 1];
  switch (which) {
    case GenomeSet::body_radius: return {&config.body.radius, 1.1754943508222875e-38f, 1000.0f};
    case GenomeSet::body_density: return {&config.body.density, 1.1754943508222875e-38f, 1000.0f};
    case GenomeSet::motor_force_scale: break;
    case GenomeSet::motor_angle: return {&config.motor.angle, 0.0f, 180.0f};
    case GenomeSet::sensor_ray_spread: return {&config.sensor.ray_spread, 0.0f, 180.0f};
    case GenomeSet::sensor_ray_length: return {&config.sensor.ray_length, 1.1754943508222875e-38f, 100000.0f};
    case GenomeSet::sensor_smell_decay: return {&config.sensor.smell_decay, 0.001f, 10.0f};
    case GenomeSet::sensor_nose_angle: return {&config.sensor.nose_angle, 0.0f, 180.0f};
    case GenomeSet::sensor_mouth_spread: return {&config.sensor.mouth_spread, 1.1754943508222875e-38f, 180.0f};
    case GenomeSet::sensor_mouth_center: return {&config.sensor.mouth_center, -180.0f, 180.0f};
    case GenomeSet::store_capacity: return {&own.capacity, 1.1754943508222875e-38f, 1000000.0f};
    case GenomeSet::store_basic_cost: return {&own.basic_cost, 0.0f, 10000.0f};
    case GenomeSet::store_action_cost: return {&own.action_cost, 0.0f, 10000.0f};
    case GenomeSet::store_decay: return {&own.decay, 0.0f, 1.0f};
    case GenomeSet::store_child_share: return {&own.child_share, 0.0f, 1.0f};
    case GenomeSet::store_hazard_weight: return {&own.hazard_weight, 0.0f, 10000.0f};
    case GenomeSet::store_birth_weight: return {&own.birth_weight, -10000.0f, 10000.0f};
    case GenomeSet::store_motor_threshold: return {&own.motor_threshold, 0.0f, 1000.0f};
    case GenomeSet::hazard_kappa: return {&config.hazard.kappa, 0.0f, 1.0f};
    case GenomeSet::hazard_alpha_energy: return {&config.hazard.alpha_energy, 0.0f, 1000000.0f};
    case GenomeSet::hazard_beta_energy: return {&config.hazard.beta_energy, 0.0f, 100.0f};
    case GenomeSet::hazard_alpha_age: return {&config.hazard.alpha_age, 0.0f, 1.0f};
    case GenomeSet::hazard_beta_age: return {&config.hazard.beta_age, 0.0f, 1.0f};
    case GenomeSet::birth_kappa: return {&config.birth.kappa, 0.0f, 1.0f};
    case GenomeSet::birth_beta: return {&config.birth.beta, 0.0f, 100.0f};
    case GenomeSet::birth_logit_offset: return {&config.birth.logit_offset, -1000.0f, 1000.0f};
    case GenomeSet::birth_distance_sd: break;
    case GenomeSet::birth_network_noise: return {&config.birth.network_noise, 0.0f, 10.0f};
    case GenomeSet::birth_mating_range: return {&config.birth.mating_range, 0.0f, 10000.0f};
    case GenomeSet::reward_drive_exponent: return {&config.reward.drive_exponent, 1.0f, 8.0f};
    case GenomeSet::reward_drive_root: return {&config.reward.drive_root, 1.0f, 8.0f};
  }
  return {nullptr, 0.0f, 0.0f};
}

}  // namespace hedon
