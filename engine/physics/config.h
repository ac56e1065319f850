/// Settings of the rigid-body physics. Meaning, unit, range and source of each are in `src/hedon/config/physics.py`.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

/// How contacts are solved: `SequentialSolver`, `JacobiSolver`.
enum class ContactSolver : int32_t { sequential, jacobi };
inline constexpr const char* CONTACT_SOLVER_NAMES[] = {"sequential", "jacobi"};

struct PhysicsConfig {
  float dt;
  int32_t substeps;
  ContactSolver solver;
  int32_t velocity_passes;
  int32_t position_passes;
  float linear_damping;
  float angular_damping;
  float max_speed;
  float max_angular_speed;
  float friction;
  float restitution;
  float restitution_threshold;
  float correction_rate;
  float slop;
  float max_correction;
  float neighbor_skin;

  HEDON_FIELDS(PhysicsConfig, dt, substeps, solver, velocity_passes, position_passes, linear_damping, angular_damping,
               max_speed, max_angular_speed, friction, restitution, restitution_threshold, correction_rate, slop,
               max_correction, neighbor_skin)
};

}  // namespace hedon
