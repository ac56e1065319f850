/// Names of the values of every enumeration in the config, for programs that fill it from text.
#pragma once

#include "world/config.h"

namespace hedon {

/// Names of an enumeration's values, for `fill`.
template <class E>
struct EnumNames;
#define HEDON_ENUM(E, names)             \
  template <>                            \
  struct EnumNames<E> {                  \
    static constexpr auto& text = names; \
  }
HEDON_ENUM(ContactSolver, CONTACT_SOLVER_NAMES);
HEDON_ENUM(Policy, POLICY_NAMES);
HEDON_ENUM(CriticTarget, CRITIC_TARGET_NAMES);
HEDON_ENUM(ActingWeights, ACTING_WEIGHTS_NAMES);
HEDON_ENUM(MutationNoise, MUTATION_NOISE_NAMES);
HEDON_ENUM(MutationLaw, MUTATION_LAW_NAMES);
HEDON_ENUM(ActionNorm, ACTION_NORM_NAMES);
HEDON_ENUM(RewardInput, REWARD_INPUT_NAMES);
HEDON_ENUM(RewardFamily, REWARD_FAMILY_NAMES);
HEDON_ENUM(LearningParameter, LEARNING_PARAMETER_NAMES);
HEDON_ENUM(ObservationScaling, OBSERVATION_SCALING_NAMES);
HEDON_ENUM(PlacementForm, PLACEMENT_FORM_NAMES);
HEDON_ENUM(ScheduleForm, SCHEDULE_FORM_NAMES);
HEDON_ENUM(Starvation, STARVATION_NAMES);
HEDON_ENUM(RayInside, RAY_INSIDE_NAMES);
HEDON_ENUM(EatenFoodRule, EATEN_FOOD_NAMES);
HEDON_ENUM(Mouths, MOUTHS_NAMES);
HEDON_ENUM(PreySharing, PREY_SHARING_NAMES);
HEDON_ENUM(BirthOrder, BIRTH_ORDER_NAMES);
HEDON_ENUM(Inheritance, INHERITANCE_NAMES);
HEDON_ENUM(Parents, PARENTS_NAMES);
HEDON_ENUM(ChildHeading, CHILD_HEADING_NAMES);
HEDON_ENUM(ChildNetwork, CHILD_NETWORK_NAMES);
HEDON_ENUM(Mating, MATING_NAMES);
#undef HEDON_ENUM

}  // namespace hedon
