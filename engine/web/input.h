/// The input for a world in a web page, as text: one setting per line, `path=value`.
///
/// Paths follow the structs, as in `food[0].energy`. In addition to the config there are `seed=1`, `outer_walls=20`,
/// and one `wall=ax,ay,bx,by` for each wall. A missing, repeated or unknown path is an error, and so is a value that is
/// neither a number nor a known name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/config.h"
#include "physics/body.h"

namespace hedon {

struct WorldInput {
  Config config;
  std::vector<Segment> walls;
  int64_t outer_walls;
  uint64_t seed;
};

/// Reads `text` into `out`; returns "", or the first error. Does not check ranges: see `check_config`.
std::string read_input(const std::string& text, WorldInput& out);

}  // namespace hedon
