/// Steps of driven worlds for callers without Python, such as a compiled JAX program: plain memory in, plain memory
/// out, and a message if something is wrong.
#pragma once

#include <cstdint>

namespace hedon {

/// The numbers of a call that are constant for a program.
struct BatchCall {
  int64_t function;    ///< address of `step_batch`, for its caller
  int64_t simulation;  ///< `PythonSimulation::id`
  int64_t species;
  int64_t form;     ///< an `ActionForm`
  int64_t repeat;   ///< world steps per call
  int64_t begins;   ///< 1 to begin all worlds, whose previous states are then not read
  int64_t slots;    ///< of the species in a world
  int64_t entries;  ///< of an observation
  int64_t watch;    ///< address of a `Watch`; 0 for none
};

/// When a `Watch` is called.
enum class Watched : int32_t { BEFORE_STEP, AFTER_STEP, BEGIN, FAULT };

/// Called before and after each step of the worlds, before some of them begin again, and at a fault. It may read the
/// simulation, and writes the records. For `BEGIN`, `begins` indicates for each world whether it is about to begin
/// again, with its seed in `seeds`; otherwise both are null. If it returns a value other than 0, the call ends, and
/// `complaint` has a zero-terminated message.
using Watch = int32_t (*)(int32_t watched, const bool* begins, const uint64_t* seeds, char* complaint, int64_t room);

/// The input of a call: a row for each world.
struct BatchIn {
  const int32_t* world;      ///< of each row, in order; 0 for all rows if the worlds have begun alike
  const uint32_t* turn;      ///< of the state to continue from
  const uint32_t* key;       ///< (…, 2) two halves of the seed of a world that begins in this call
  const int32_t* ids;        ///< (…, slots) the agents of that state, -1 for empty slots
  const float* actions;      ///< (…, slots, 2)
  const int32_t* max_steps;  ///< steps after which a world begins again; 0 for never
};

/// The output of a call: a row for each world.
struct BatchOut {
  int32_t* world;
  uint32_t* turn;
  int32_t* ids;
  float* observations;  ///< (…, slots, entries)
  float* rewards;       ///< (…, slots) of the agents that were alive before the steps
  bool* terminated;     ///< (…, slots) whether that agent died during the steps
  bool* done;           ///< whether the world was over, and has begun again
};

/// rows       of `in` and `out`: one for each world of the simulation; a single row begins all worlds with one seed
/// complaint  receives a zero-terminated message, empty on success, in which case the worlds have done the steps
void step_batch(const BatchCall* call, const BatchIn* in, const BatchOut* out, int64_t rows, char* complaint,
                int64_t room) noexcept;

}  // namespace hedon
