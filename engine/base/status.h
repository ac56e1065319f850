/// All errors that can occur in a step or be found at the end of a window, in one table. The state keeps the first one;
/// the binding raises it.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

enum class Status : int32_t {
  ok = 0,
  neighbor_overflow,
  contact_outside_skin,
  birth_overflow,
  not_finite,
  outside_arena,
  initial_placement,
  id_overflow,
  overlap_too_deep,
  slots_inconsistent,
  ids_inconsistent,
  counts_inconsistent,
  ledger_open,
  rule_not_finite,
  rule_no_chance,
  rule_wrote,
  count,
};

struct StatusText {
  const char* name;
  const char* sentence;
  const char* remedy;
};

/// For errors that no setting can explain.
inline constexpr const char* REPEAT =
    "Run `hedon check RUN --fault`. If the fault does not happen again, the likely cause is bad memory in this "
    "machine.";

inline constexpr StatusText STATUS_TEXT[] = {
    {"ok", "No error.", ""},
    {"neighbor_overflow", "There are more neighboring pairs than the list can hold.",
     "Lower the number of agents, physics.neighbor_skin, physics.max_speed or the forces."},
    {"contact_outside_skin", "A body moved further than the neighbor list allows.",
     "Raise physics.neighbor_skin or lower physics.max_speed."},
    {"birth_overflow", "There were more births in a window than can wait for their genomes.",
     "Shorten world.rollout_steps, or set world.inheritance to \"at_birth\"."},
    {"not_finite", "A number of the state is not finite.",
     "Check the named agent; lower learning.learning_rate or the forces."},
    {"outside_arena", "A body left the arena.", "Lower physics.max_speed, physics.dt or the forces."},
    {"initial_placement", "There is no free place in the arena for all obstacles, initial agents or foods.",
     "Lower the initial counts or enlarge the arena."},
    {"id_overflow", "A counter of agents or steps has reached its limit.", "Start a new run."},
    {"overlap_too_deep", "A body overlaps another body, a food or a wall so far that contacts cannot separate them.",
     "Lower the forces, physics.max_speed or physics.dt, so that no body moves half its radius in a substep."},
    {"slots_inconsistent", "A slot is used twice, or is neither used nor free.", REPEAT},
    {"ids_inconsistent", "The living are not in the order of their ids, or an id was not given to any agent.", REPEAT},
    {"counts_inconsistent", "Counts of births, deaths or foods do not agree with the world.", REPEAT},
    {"ledger_open", "The energy of the agents differs from the sum in the ledger.", REPEAT},
    {"rule_not_finite", "A rule paid an agent, or kept for it, a number that is not finite; pay must be below 3.4e38.",
     "Check the species' reward.rule for this agent: an exception, a division by 0, or a memory that grows without "
     "end."},
    {"rule_no_chance", "A rule gave a chance of death or birth that is not between 0 and 1.",
     "Check the species' hazard.rule and birth.rule for this agent: an exception, or a formula without a limit, say "
     "min(chance, 1.0)."},
    {"rule_wrote", "A rule of hazard or birth changed an agent's memory.",
     "Only the species' reward.rule may write to memories: let it do so."},
};
static_assert(sizeof(STATUS_TEXT) / sizeof(StatusText) == static_cast<int>(Status::count));

/// The first error of a world: what, when, which agents, and the wrong value. An id is -1 if there is no agent.
struct Fault {
  Status status;
  int32_t agent_id;
  int64_t step;
  double value;
  int32_t other_id;  ///< the other agent of a pair; of a fault of a rule, its species · `RULE_USES` + its use
  int32_t reserved;

  HEDON_FIELDS(Fault, status, agent_id, step, value, other_id, reserved)
};

}  // namespace hedon
