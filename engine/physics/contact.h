/// Contacts of one substep, with all the data that the solver needs.
///
/// Impulses are stored per mass [u/s]: of the body itself at a static object, of a body of the first class between two
/// bodies. A normal impulse passes through the center, so it never rotates a disc. `arm` is the distance from the
/// center to the contact point, which is halfway between the two surfaces.
#pragma once

#include <cstdint>

namespace hedon {

/// What a body is paired with.
enum class PairKind : int32_t { body, circle, wall };

/// Velocities of one body, adjacent in memory because contacts read and write them together.
struct alignas(16) Motion {
  float x, y;     ///< velocity [u/s]
  float angular;  ///< angular velocity [rad/s]
  float unused;
};

/// Two bodies of one class that overlap.
struct BodyContact {
  int32_t first, second;     ///< indices
  float normal_x, normal_y;  ///< unit vector from the first center to the second
  float arm;                 ///< [u]
  float turn;                ///< change of angular velocity per tangential impulse [1/u]
  float tangent_mass;        ///< effective mass along the tangent, per mass of a body
  float normal_impulse;      ///< accumulated, >= 0 [u/s]
  float tangent_impulse;     ///< accumulated [u/s]
  float approach;            ///< normal velocity before solving; negative where they approach [u/s]
  int32_t pair;              ///< in the list
};

/// Two bodies that overlap, of any classes.
struct MixedContact {
  int32_t first, second;              ///< indices
  float normal_x, normal_y;           ///< unit vector from the first center to the second
  float arm_first, arm_second;        ///< [u]
  float turn_first, turn_second;      ///< change of angular velocity per tangential impulse [1/u]
  float weight_first, weight_second;  ///< change of velocity per impulse: mass of the first class / mass of the body
  float normal_mass, tangent_mass;    ///< effective masses, per mass of a body of the first class
  float normal_impulse;               ///< accumulated, >= 0 [u/s]
  float tangent_impulse;              ///< accumulated [u/s]
  float approach;                     ///< normal velocity before solving; negative where they approach [u/s]
  int32_t pair;                       ///< in the list
};

/// A body that overlaps a static circle or a wall.
struct StaticContact {
  int32_t body;              ///< index
  float anchor_x, anchor_y;  ///< where the body's center would just touch [u]
  float normal_x, normal_y;  ///< unit vector from the body's center to the circle's or to the wall's nearest point
  float arm;                 ///< [u]
  float turn;                ///< change of angular velocity per tangential impulse [1/u]
  float tangent_mass;        ///< effective mass along the tangent, per mass of a body
  float friction;            ///< coefficient
  float restitution;         ///< coefficient
  float normal_impulse;      ///< accumulated, >= 0 [u/s]
  float tangent_impulse;     ///< accumulated [u/s]
  float approach;            ///< normal velocity before solving; negative where they approach [u/s]
  int32_t pair;              ///< in the list
};

}  // namespace hedon
