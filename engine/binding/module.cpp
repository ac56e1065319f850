/// The Python module `hedon._engine`. Each part of the engine adds its own functions, so that tests drive the parts.
#include <nanobind/nanobind.h>

#include "binding/parts.h"

NB_MODULE(_engine, module) {
  module.doc() = "The native engine of hedon: the simulation and nothing else.";
  hedon::bind_kernel(module);
  hedon::bind_learning(module);
  hedon::bind_physics(module);
  hedon::bind_random(module);
  hedon::bind_simulation(module);
}
