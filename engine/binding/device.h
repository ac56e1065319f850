/// Loads the library of a device: `hedon_device` of a file.
#pragma once

#include <string>

#include "simulation/device.h"

namespace hedon {

/// The program of the library in a file; it stays loaded. EngineError, in one sentence: the file cannot be loaded, is
/// of other sources, or there is no device.
const DeviceProgram* open_device(const std::string& file);

/// The program of the library in a file, ready for worlds of a config; it stays loaded. EngineError, in one sentence:
/// the file cannot be loaded, is of other sources, has no device, or the config asks for what a device does not do.
const DeviceProgram* need_device(const std::string& file, const Config& config);

}  // namespace hedon
