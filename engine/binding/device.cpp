#include "binding/device.h"

#if !defined(_WIN32)
#include <dlfcn.h>
#endif

#include "binding/error.h"

namespace hedon {
namespace {

/// Refuses configs that only the host supports, and networks that a device cannot update.
void need_fit(const DeviceProgram& program, const Config& config) {
  const WorldShape shape = make_shape(config, 0, 0);
  for (int32_t s = 0; s < shape.species; ++s) {
    const std::string species = "species " + std::to_string(s);
    if (config.layout[s].has_rule())
      throw EngineError(species + " has a rule in Python, which a device cannot call: run it without a device");
    if (config.species[s].learning.policy == LearningPolicy::external)
      throw EngineError(species +
                        " waits for actions of a program, which a device cannot ask: run it without a device");
    const int32_t inputs = shape.of[s].network.observation.size();
    if (shape.of[s].learns && inputs > program.widest_network)
      throw EngineError("the networks of " + species + " have " + std::to_string(inputs) + " inputs, and device '" +
                        program.name + "' learns with at most " + std::to_string(program.widest_network) +
                        ": let it see fewer types, or use fewer rays or sectors");
  }
}

/// The function of a device's library that gives its program.
DeviceEntry find_entry(const std::string& file) {
#if defined(_WIN32)
  throw EngineError(file + " cannot be loaded: devices are supported only on Linux");
#else
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw EngineError("the library of the device cannot be loaded: " + std::string(dlerror()));
  const DeviceEntry entry = reinterpret_cast<DeviceEntry>(dlsym(library, "hedon_device"));
  if (entry == nullptr) throw EngineError(file + " is not the library of a device");
  return entry;
#endif
}

}  // namespace

const DeviceProgram* open_device(const std::string& file) {
  const DeviceProgram& program = *find_entry(file)();
  if (program.layout != device_layout())
    throw EngineError(file + " was built from other sources than the engine: build both again");
  const std::string problem = program.open();
  if (!problem.empty()) throw EngineError("device '" + std::string(program.name) + "' cannot be used: " + problem);
  return &program;
}

const DeviceProgram* need_device(const std::string& file, const Config& config) {
  const DeviceProgram* const program = open_device(file);
  need_fit(*program, config);
  return program;
}

}  // namespace hedon
