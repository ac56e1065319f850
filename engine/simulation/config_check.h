/// The engine's own door: what its memory and its loops rest upon holds of a config, whoever hands it over.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/vec2.h"
#include "physics/body.h"
#include "world/config.h"

namespace hedon {

/// What is wrong with a config, by the path of the setting; "" where it can be run. Ranges are those of
/// `src/hedon/config/`, or wider: people read their messages, this one keeps the engine whole.
std::string check_config(const WorldConfig& config);

/// The same for what comes beside the config.
/// walls        the first `outer_walls` of them make up the closed outer polygon
/// slot_order   each slot once, or nothing
std::string check_company(const WorldConfig& config, const std::vector<Segment>& walls, int64_t outer_walls,
                          int64_t worlds, int64_t threads, const std::vector<int32_t>& slot_order);

}  // namespace hedon
