/// Converts checkpoints to dicts of NumPy arrays or to one byte string, and back.
#pragma once

#include <nanobind/nanobind.h>

#include "binding/python_simulation.h"
#include "simulation/checkpoint.h"

namespace hedon {

nanobind::dict to_arrays(Checkpoint checkpoint);

/// Calls begin(name, type, shape) for each array of a world in turn, then piece(bytes) until all its bytes are given.
void save_to(PythonSimulation& self, int world, const nanobind::callable& begin, const nanobind::callable& piece);

/// Replaces a world by a saved one, whose arrays are read from the caller's memory. ValueError: the checkpoint is
/// invalid; the world is then unchanged.
void restore_from(PythonSimulation& self, int world, const nanobind::dict& arrays);

/// Packs all worlds with a text of the caller's into one piece of memory that Python owns from the start.
nanobind::bytes pack(PythonSimulation& self, const nanobind::bytes& head);

/// The caller's text in the result of `pack`. ValueError: it is damaged, or not a result of `pack`.
nanobind::bytes packed_head(const nanobind::bytes& bytes);

/// Replaces all worlds by the ones in the result of `pack`. ValueError: it is invalid; all worlds are then unchanged.
void unpack_into(PythonSimulation& self, const nanobind::bytes& bytes);

}  // namespace hedon
