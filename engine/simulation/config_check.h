/// The engine's own check of its input. Its memory and its loops rely on these rules, whatever the caller.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec2.h"
#include "config/config.h"
#include "physics/body.h"

namespace hedon {

/// What is wrong with a config, with the path of the setting; "" if it can be run. Ranges are as in
/// `src/hedon/config/`, or wider: users see the messages from there, and this check protects the engine.
std::string check_config(const Config& config);

/// The same for the other arguments.
/// walls        the first `outer_walls` of them make up the closed outer polygon
/// slot_order   each slot once, or empty
std::string check_arguments(const Config& config, const std::vector<Segment>& walls, int64_t outer_walls,
                            int64_t worlds, int64_t threads, const std::vector<int32_t>& slot_order);

}  // namespace hedon
