/// Steps of driven worlds for callers without Python, such as a compiled program of JAX: plain memory in, plain memory
/// out, and a text where something is wrong.
#pragma once

#include <cstdint>

namespace hedon {

/// Numbers of a call that stay the same for a program.
struct BatchCall {
  int64_t function;    ///< address of `step_batch`, for who calls it
  int64_t simulation;  ///< `PythonSimulation::id`
  int64_t species;
  int64_t form;     ///< an `ActionForm`
  int64_t repeat;   ///< steps of the worlds in one step
  int64_t begins;   ///< 1 to begin all worlds: what they were before is then not read
  int64_t slots;    ///< of the species in a world
  int64_t entries;  ///< of an observation
  int64_t watch;    ///< address of a `Watch`; 0 for none
};

/// When a `Watch` is called.
enum class Watched : int32_t { BEFORE_STEP, AFTER_STEP, BEGIN, FAULT };

/// Called before and after each step of the worlds, before some of them begin again, and at a fault; it may read the
/// simulation, and writes its records. For `BEGIN`, `begins` tells for each world whether it is about to begin again,
/// by its seed in `seeds`; otherwise both are null. If it returns anything but 0, the call ends, and `complaint` has a
/// text with a zero at its end.
using Watch = int32_t (*)(int32_t watched, const bool* begins, const uint64_t* seeds, char* complaint, int64_t room);

/// What a call reads: a row for each world.
struct BatchIn {
  const int32_t* world;      ///< of each row, in order; 0 for all rows if the worlds have begun alike
  const uint32_t* turn;      ///< of the state that is gone on from
  const uint32_t* key;       ///< (…, 2) two halves of the seed of a world that begins in this call
  const int32_t* ids;        ///< (…, slots) the agents of that state, -1 where nobody lives
  const float* actions;      ///< (…, slots, 2)
  const int32_t* max_steps;  ///< steps of a world after which it begins again; 0 for no end
};

/// What a call writes: a row for each world.
struct BatchOut {
  int32_t* world;
  uint32_t* turn;
  int32_t* ids;
  float* observations;  ///< (…, slots, entries)
  float* rewards;       ///< (…, slots) of who was there before the steps
  bool* terminated;     ///< (…, slots) whether that agent died in them
  bool* done;           ///< whether the world was over, and has begun again
};

/// rows       of `in` and `out`: one for each world of the simulation; one alone begins all worlds alike, by one seed
/// complaint  gets a text with a zero at its end, empty if all is well; then the worlds have done the steps
void step_batch(const BatchCall* call, const BatchIn* in, const BatchOut* out, int64_t rows, char* complaint,
                int64_t room) noexcept;

}  // namespace hedon
