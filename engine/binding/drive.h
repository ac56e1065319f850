/// Actions, observations and rewards for a caller that drives agents, in the caller's NumPy arrays.
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

/// The index of an invalid action of a living agent, or -1. ValueError: an array has another shape.
int64_t wrong_action(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form);

/// Sets the actions of the agents of an external species: (worlds, slots, 2). Returns -1, or the index of an action out
/// of bounds. ValueError: an array has another shape.
int64_t set_actions(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form);

/// Writes their observations, their rewards in the last step, and their ids: (worlds, slots, …). Returns the number of
/// slots that now have another agent, or none.
int64_t read_observations(PythonSimulation& self, int32_t species, TableOut observation, RowsOut reward,
                          IdsOut agent_id);

/// The same without observations.
void read_rewards(PythonSimulation& self, int32_t species, RowsOut reward, IdsOut agent_id);

/// The numbers of meals of a species since the worlds began: (worlds, meals).
nanobind::object meals_of(PythonSimulation& self, int32_t species);

}  // namespace hedon
