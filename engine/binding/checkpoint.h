/// Checkpoints as dicts of NumPy arrays or as one string of bytes, and back.
#pragma once

#include <nanobind/nanobind.h>

#include "binding/python_simulation.h"
#include "simulation/checkpoint.h"

namespace hedon {

nanobind::dict to_arrays(Checkpoint checkpoint);

/// Calls begin(name, type, shape) for each array of a world in turn, then piece(bytes) until all its bytes are given.
void save_to(PythonSimulation& self, int world, const nanobind::callable& begin, const nanobind::callable& piece);

/// Replaces a world by a saved one, whose arrays are read where the caller has them. ValueError: what is wrong; the
/// world is then unchanged.
void restore_from(PythonSimulation& self, int world, const nanobind::dict& arrays);

/// All worlds with a text of the caller's, in one piece of memory that Python owns from the start.
nanobind::bytes pack(PythonSimulation& self, const nanobind::bytes& head);

/// The text of the caller's in what `pack` gave. ValueError: it is damaged, or something else.
nanobind::bytes packed_head(const nanobind::bytes& bytes);

/// Replaces all worlds by those in what `pack` gave. ValueError: what is wrong; all worlds are then unchanged.
void unpack_into(PythonSimulation& self, const nanobind::bytes& bytes);

}  // namespace hedon
