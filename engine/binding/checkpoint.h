/// Checkpoints as dicts of NumPy arrays, and back.
#pragma once

#include <nanobind/nanobind.h>

#include "simulation/checkpoint.h"

namespace hedon {

nanobind::dict to_arrays(Checkpoint checkpoint);

/// Throws value_error if something is not an array of plain numbers.
Checkpoint from_arrays(const nanobind::dict& arrays);

}  // namespace hedon
