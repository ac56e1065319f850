/// The Python module `hedon._engine`. Each part of the engine adds its functions, so that tests can call them directly.
#include <nanobind/nanobind.h>

#include <stdexcept>

#include "binding/error.h"
#include "binding/parts.h"

namespace {

/// Turns `EngineError` into the package's error of that name.
void translate(const std::exception_ptr& pointer, void*) {
  try {
    std::rethrow_exception(pointer);
  } catch (const hedon::EngineError& error) {
    const nanobind::object type = nanobind::module_::import_("hedon.error").attr("EngineError");
    PyErr_SetString(type.ptr(), error.what());
  }
}

/// Raises ImportError in any interpreter but the main one, where nanobind would wait forever for a lock that it holds
/// itself.
void need_main_interpreter() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return;
  throw std::runtime_error(
      "hedon's engine cannot be used in a sub-interpreter of Python, where it would hang: use processes instead "
      "(multiprocessing)");
}

}  // namespace

NB_MODULE(_engine, module) {
  need_main_interpreter();
  module.doc() = "The native engine of hedon: the simulation and nothing else.";
  nanobind::register_exception_translator(translate);
  hedon::bind_kernel(module);
  hedon::bind_learning(module);
  hedon::bind_physics(module);
  hedon::bind_random(module);
  hedon::bind_simulation(module);
}
