/// Converts the engine's config structs from and to nested Python dicts and sequences.
#pragma once

#include <nanobind/nanobind.h>

#include "config/config.h"

namespace hedon {

/// A config struct from a nested dict: `Config`, `LearningConfig` or `PhysicsConfig`.
/// A missing name, an extra name or a value of the wrong type is an error that gives the path.
template <class T>
T to_config(nanobind::dict dict);

/// The inverse, for a test that every setting arrives.
nanobind::object from_config(const Config& config);

}  // namespace hedon
