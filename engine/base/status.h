/// What can go wrong inside a step, in one table. The state keeps the first; the binding raises it.
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
  count,
};

struct StatusText {
  const char* name;
  const char* sentence;
  const char* remedy;
};

inline constexpr StatusText STATUS_TEXT[] = {
    {"ok", "No error.", ""},
    {"neighbor_overflow", "More neighboring pairs than the list can hold.",
     "Lower the number of agents, physics.neighbor_skin, physics.max_speed or the forces."},
    {"contact_outside_skin", "A body moved further than the neighbor list allows for.",
     "Raise physics.neighbor_skin or lower physics.max_speed."},
    {"event_overflow", "More births or deaths between two reads than the event buffer holds.",
     "Read the events more often."},
    {"not_finite", "A number of the state is not finite.",
     "Look at the named agent; lower learning.learning_rate or the forces."},
    {"outside_arena", "A body left the arena.", "Lower physics.max_speed, physics.dt or the forces."},
    {"initial_placement", "The initial agents or foods find no free place in the arena.",
     "Lower the initial counts or enlarge the arena."},
    {"id_overflow", "A counter of agents or steps is exhausted.", "Start a new run."},
};
static_assert(sizeof(STATUS_TEXT) / sizeof(StatusText) == static_cast<int>(Status::count));

/// The first error of a world: what, when, who, and the offending value. `agent_id` is -1 where nobody is concerned.
struct Fault {
  Status status;
  int32_t agent_id;
  int64_t step;
  double value;

  HEDON_FIELDS(Fault, status, agent_id, step, value)
};

}  // namespace hedon
