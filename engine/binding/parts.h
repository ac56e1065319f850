/// The functions with which each part of the binding adds itself to the module.
#pragma once

#include <nanobind/nanobind.h>

namespace hedon {

void bind_kernel(nanobind::module_& module);
void bind_learning(nanobind::module_& module);
void bind_physics(nanobind::module_& module);
void bind_random(nanobind::module_& module);
void bind_simulation(nanobind::module_& module);

}  // namespace hedon
