/// What can go wrong inside a step or be found at the end of a window, in one table. The state keeps the first; the
/// binding raises it.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace hedon {

enum class Status : int32_t {
  ok = 0,
  neighbor_overflow,
  contact_outside_skin,
  event_overflow,
  not_finite,
  outside_arena,
  initial_placement,
  id_overflow,
  overlap_too_deep,
  slots_inconsistent,
  ids_inconsistent,
  counts_inconsistent,
  ledger_open,
  count,
};

struct StatusText {
  const char* name;
  const char* sentence;
  const char* remedy;
};

/// For what no setting explains.
inline constexpr const char* REPEAT =
    "Repeat it by `hedon replay-fault`: if it does not recur, suspect the memory of this machine.";

inline constexpr StatusText STATUS_TEXT[] = {
    {"ok", "No error.", ""},
    {"neighbor_overflow", "More neighboring pairs than the list can hold.",
     "Lower the number of agents, physics.neighbor_skin, physics.max_speed or the forces."},
    {"contact_outside_skin", "A body moved further than the neighbor list allows for.",
     "Raise physics.neighbor_skin or lower physics.max_speed."},
    {"event_overflow", "More births or deaths between two reads than the event buffer holds.",
     "Read them more often: `World.deaths` takes them."},
    {"not_finite", "A number of the state is not finite.",
     "Look at the named agent; lower learning.learning_rate or the forces."},
    {"outside_arena", "A body left the arena.", "Lower physics.max_speed, physics.dt or the forces."},
    {"initial_placement", "The initial agents or foods find no free place in the arena.",
     "Lower the initial counts or enlarge the arena."},
    {"id_overflow", "A counter of agents or steps is exhausted.", "Start a new run."},
    {"overlap_too_deep", "A body lies deeper in another, in a food or in a wall than contacts can mend.",
     "Lower the forces, physics.max_speed or physics.dt, so that no body moves half its radius in a substep."},
    {"slots_inconsistent", "A slot is held twice, or neither held nor free.", REPEAT},
    {"ids_inconsistent", "The living do not stand in the order of their ids, or an id was never given.", REPEAT},
    {"counts_inconsistent", "Births, deaths or foods do not add up to what is there.", REPEAT},
    {"ledger_open", "What the agents hold differs from what the ledger says that they hold.", REPEAT},
};
static_assert(sizeof(STATUS_TEXT) / sizeof(StatusText) == static_cast<int>(Status::count));

/// The first error of a world: what, when, who, and the offending value. An id is -1 where nobody is concerned.
struct Fault {
  Status status;
  int32_t agent_id;
  int64_t step;
  double value;
  int32_t other_id;  ///< the other agent of a pair
  int32_t reserved;

  HEDON_FIELDS(Fault, status, agent_id, step, value, other_id, reserved)
};

}  // namespace hedon
