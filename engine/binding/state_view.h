/// Views of the arrays of a world's state, by path, for NumPy.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <string>

#include "binding/python_simulation.h"

namespace hedon {

/// A read-only view of one array of a world's state; columns of structs are strided. Packed observations are bytes,
/// (slots, rollout_steps + 1, 192), as `learning.unpack` takes them. KeyError: there is no such array.
nanobind::object view_state(nanobind::handle self, int index, const std::string& path);

/// The paths that `view_state` knows.
nanobind::list state_names(PythonSimulation& self);

}  // namespace hedon
