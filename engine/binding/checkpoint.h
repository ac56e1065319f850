/// Checkpoints as dicts of NumPy arrays or as one string of bytes, and back.
#pragma once

#include <nanobind/nanobind.h>

#include "binding/python_simulation.h"
#include "simulation/checkpoint.h"

namespace hedon {

nanobind::dict to_arrays(Checkpoint checkpoint);

/// Throws value_error if something is not an array of plain numbers.
Checkpoint from_arrays(const nanobind::dict& arrays);

/// All worlds with a text of the caller's, in one piece of memory that Python owns from the start.
nanobind::bytes pack(PythonSimulation& self, const nanobind::bytes& head);

/// The text of the caller's in what `pack` gave. ValueError: it is damaged, or something else.
nanobind::bytes packed_head(const nanobind::bytes& bytes);

/// Replaces all worlds by those in what `pack` gave. ValueError: what is wrong; all worlds are then unchanged.
void unpack_into(PythonSimulation& self, const nanobind::bytes& bytes);

}  // namespace hedon
