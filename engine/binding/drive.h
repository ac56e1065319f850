/// What a caller that drives agents tells the engine and reads from it, in NumPy arrays of its own.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>

#include "binding/python_simulation.h"

namespace hedon {

using TableIn = nanobind::ndarray<const float, nanobind::ndim<3>, nanobind::c_contig, nanobind::device::cpu>;
using TableOut = nanobind::ndarray<float, nanobind::ndim<3>, nanobind::c_contig, nanobind::device::cpu>;
using RowsOut = nanobind::ndarray<float, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;
using IdsOut = nanobind::ndarray<int32_t, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;

/// Names of the forms of actions, in the order of `ActionForm`.
inline constexpr const char* ACTION_FORMS[] = {"unit", "force", "logit"};

/// Which number of a living agent cannot be its action, or -1. ValueError: an array has another shape.
int64_t wrong_action(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form);

/// Tells the agents of an external species what to do: (worlds, slots, 2). Returns -1, or which number of an agent is
/// out of bounds. ValueError: an array has another shape.
int64_t set_actions(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form);

/// Writes what they sense, what they earned in the last step, and their ids: (worlds, slots, …). Returns in how many
/// slots another agent, or none, is now.
int64_t read_observations(PythonSimulation& self, int32_t species, TableOut observation, RowsOut reward,
                          IdsOut agent_id);

/// The same without what they sense.
void read_rewards(PythonSimulation& self, int32_t species, RowsOut reward, IdsOut agent_id);

/// What the agents of a species have eaten since the worlds began: (worlds, meals).
nanobind::object meals_of(PythonSimulation& self, int32_t species);

}  // namespace hedon
