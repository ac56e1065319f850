/// Loads the library of a device, through the function `hedon_device` of a file.
#pragma once

#include <string>

#include "simulation/device.h"

namespace hedon {

/// The program of the library in a file; it stays loaded. EngineError, in one sentence: the file cannot be loaded, was
/// built from other sources, or there is no device.
const DeviceProgram* open_device(const std::string& file);

/// The program of the library in a file, ready for worlds of a config; it stays loaded. EngineError, in one sentence:
/// the file cannot be loaded, was built from other sources, finds no device, or a device does not support the config.
const DeviceProgram* need_device(const std::string& file, const Config& config);

}  // namespace hedon
