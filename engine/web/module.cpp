/// The engine's interface for a web page: plain functions exported to WebAssembly, for one world at a time.
///
/// Call them in this order: `hedon_text` gives room for the text of `WorldInput`; `hedon_read` reads and checks it;
/// `hedon_bytes_needed` returns the memory that the world would take; `hedon_make` makes it. Then call `hedon_run`,
/// `hedon_learn` and the views as often as you like. A function that can fail returns 0 for success; `hedon_message`
/// then explains the failure.
///
/// A world with several threads needs as many seats before it is made, each with a worker that serves there: see
/// `base/platform_web.cpp`.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/platform.h"
#include "lanes/portable.h"
#include "simulation/config_check.h"
#include "simulation/memory.h"
#include "simulation/simulation.h"
#include "simulation/window.h"
#include "web/edit.h"
#include "web/input.h"
#include "web/work_slice.h"

#define HEDON_EXPORT(name) extern "C" __attribute__((export_name(#name), used))

namespace hedon {
namespace {

/// The address and type of an array, which the page reads as six 32-bit integers.
struct View {
  int32_t address;
  int32_t count;   ///< numbers
  int32_t stride;  ///< bytes from one to the next
  int32_t bytes;   ///< of one number
  int32_t real;    ///< 1 for floating-point numbers
  int32_t sign;    ///< 1 for numbers that can be negative
};

/// What the chosen agent senses and its network's output.
struct AgentProbe {
  PackedObservation observation;
  ObservationExtra extra;        ///< of a wide observation
  float output[16];              ///< mean of the two actions, then the value
  float observed[MAX_CHANNELS];  ///< its observations other than rays and touch, in the order of its layout
};

constexpr size_t SPARE = size_t{4} << 20;  ///< bytes needed in addition to a world's own, with a margin

std::string text, message, path;
WorldInput input, made;  ///< the input read last, and the one that the world was made from
std::unique_ptr<Simulation> simulation;
std::vector<float> scratch;
Pace pace;
int32_t learned;  ///< learners of the present window that have learned, while the window is being learned
bool learning;
int32_t learners;
bool edited;                                                  ///< whether the world has been edited by hand
std::unique_ptr<char, decltype(&free)> kept(nullptr, &free);  ///< a copy of the world's memory; null for none
bool kept_edited;
View view;
AgentProbe probe;
const void* const PROBED[] = {probe.observation.ray, probe.observation.ray_type, probe.output, probe.observed};

int fail(const std::string& what) {
  message = what;
  return 1;
}

World& world() { return simulation->world(0); }

/// The scratch of the learner, aligned to whole cache lines.
float* aligned_scratch() {
  const auto address = reinterpret_cast<uintptr_t>(scratch.data());
  return reinterpret_cast<float*>((address + 63) / 64 * 64);
}

int64_t scratch_stride() { return learn_stride(simulation->shape(), simulation->config()); }

/// Calls body(team) on every thread of the world.
template <class Body>
void together(Body&& body) {
  TeamState shared;
  shared.size = simulation->pool().size();
  simulation->pool().run([&](int rank) {
    Team team(shared, rank);
    body(team);
  });
}

int report_fault() {
  const Fault& fault = world().fault();
  if (fault.status == Status::ok) return 0;
  const StatusText& known = STATUS_TEXT[static_cast<int>(fault.status)];
  return fail(std::string(known.name) + ": " + known.sentence + " " + known.remedy);
}

/// Fails while agents learn: a world can be edited and kept only between two windows.
int need_rest() { return learning ? fail("the agents are learning: wait until the window has ended") : 0; }

int change(const std::string& refused) {
  if (!refused.empty()) return fail(refused);
  edited = true;
  return report_fault();
}

/// Makes the world of an input, at its first step; the previous world is gone.
void make_world(const WorldInput& from, int32_t threads) {
  simulation.reset();
  made = from;
  simulation = std::make_unique<Simulation>(made.config, made.walls, static_cast<int32_t>(made.outer_walls),
                                            std::vector<uint64_t>{made.seed}, threads, find_kernel("portable"),
                                            std::vector<int32_t>{});
  scratch.assign(static_cast<size_t>(scratch_stride() * threads) + 16, 0.0f);
  pace = Pace();
}

double bytes_needed(const WorldInput& of, int32_t threads) {
  const MemoryNeed need = Simulation::bytes_needed(of.config, static_cast<int32_t>(of.walls.size()), 1, threads);
  return static_cast<double>(need.total(false));
}

template <class T>
void show(const T* first, int64_t count, int64_t stride) {
  view = {static_cast<int32_t>(reinterpret_cast<uintptr_t>(first)),
          static_cast<int32_t>(count),
          static_cast<int32_t>(stride),
          static_cast<int32_t>(sizeof(T)),
          std::is_floating_point_v<T> ? 1 : 0,
          std::is_signed_v<T> ? 1 : 0};
}

/// Looks up the array `path` of the state, or the column `array.column` of an array of structs.
bool find_view() {
  bool found = false;
  for_each_array(world().state, "", [&]<class T>(const std::string& name, Array<T>& array) {
    if constexpr (std::is_arithmetic_v<T>) {
      if (name != path) return;
      show(array.data, array.count, sizeof(T));
      found = true;
    } else if constexpr (requires { T::for_each_field([](auto...) {}); }) {
      T::for_each_field([&](const char* column, auto member) {
        using Field = std::remove_cvref_t<decltype(array.data->*member)>;
        if constexpr (std::is_arithmetic_v<Field>) {
          if (name + "." + column != path) return;
          show(&(array.data->*member), array.count, sizeof(T));
          found = true;
        }
      });
    }
  });
  return found;
}

}  // namespace

/// Returns a buffer for `bytes` bytes of input.
HEDON_EXPORT(hedon_text) char* hedon_text(int32_t bytes) {
  text.assign(static_cast<size_t>(bytes), '\0');
  return text.data();
}

/// The last message, zero-terminated.
HEDON_EXPORT(hedon_message) const char* hedon_message() { return message.c_str(); }

/// Reads and checks the input.
HEDON_EXPORT(hedon_read) int hedon_read() {
  const std::string wrong = read_input(text, input);
  if (!wrong.empty()) return fail(wrong);
  const std::string setting = check_config(input.config);
  if (!setting.empty()) return fail(setting);
  for (int32_t s = 0; s < input.config.species.count; ++s) {
    if (input.config.layout[s].has_rule()) return fail("a page cannot have rules in Python");
  }
  const std::string company = check_arguments(input.config, input.walls, input.outer_walls, 1, 1, {});
  return company.empty() ? 0 : fail(company);
}

/// Bytes that the world of the input needs, so that a page can refuse a world before reserving memory for it.
HEDON_EXPORT(hedon_bytes_needed) double hedon_bytes_needed(int32_t threads) { return bytes_needed(input, threads); }

/// Makes the world of the input, with this number of threads, which does not affect results. The previous world is
/// gone.
HEDON_EXPORT(hedon_make) int hedon_make(int32_t threads) {
  simulation.reset();
  learning = edited = false;
  kept.reset();
  if (threads > available_processors()) return fail("there are fewer threads than the world is to have");
  const auto bytes = static_cast<size_t>(hedon_bytes_needed(threads)) + SPARE;
  void* room = reserve_pages(bytes);
  if (room == nullptr)
    return fail("there is no memory left for this world: lower population.capacity or world.rollout_steps");
  release_pages(room, bytes);
  make_world(input, threads);
  prepare_step(Alone{}, world());
  return report_fault();
}

/// Continues the world with the settings of the input, as `hedon branch` does. The kept copy is discarded. If the state
/// does not fit the settings, the world stays as it is.
HEDON_EXPORT(hedon_change) int hedon_change() {
  if (need_rest() != 0) return 1;
  const int32_t threads = simulation->pool().size();
  if (bytes_needed(input, threads) != bytes_needed(made, threads)) return fail("this setting needs a new beginning");
  kept.reset();
  const Checkpoint state = simulation->save(0);
  const WorldInput before = made;
  make_world(input, threads);
  std::string wrong = simulation->restore(0, state);
  if (!wrong.empty()) {
    make_world(before, threads);
    simulation->restore(0, state);
  }
  prepare_step(Alone{}, world());
  return change(wrong);
}

/// Advances by up to `steps` steps, but not past the end of a window that has not been learned. Returns the steps
/// done; fewer if the world is over, has a fault, or must learn.
HEDON_EXPORT(hedon_run) int32_t hedon_run(int32_t steps) {
  if (learning || world().over()) return 0;
  const int64_t window = simulation->shape().steps, begun = world().head().step;
  const int64_t whole = std::min<int64_t>(steps, window - begun % window);
  together([&](Team& team) {
    for (int64_t left = whole; left > 0 && !world().over();)
      left -= step_at_pace(team, pace, left, [&](Team& members) {
        step(members, world(), world().head().step % window, [](Part) {});
        return !world().over();
      });
  });
  if (world().head().step % window == 0 && !world().over()) {
    learning = true;
    learned = learners = 0;
  }
  return static_cast<int32_t>(world().head().step - begun);
}

/// Whether a window has ended whose learning is not done: 1 if `hedon_learn` must be called before the next step.
HEDON_EXPORT(hedon_must_learn) int hedon_must_learn() { return learning ? 1 : 0; }

/// Trains the next `count` learners; returns how many are left.
HEDON_EXPORT(hedon_learn) int32_t hedon_learn(int32_t count) {
  if (!learning) return 0;
  together([&](Team& team) {
    WorkSlice slice(team, learned, learned + count);
    learn_window(slice, world(), aligned_scratch(), scratch_stride(), [](int32_t) {});
    if (slice.done()) audit(team, world(), [](int32_t) {});
    if (team.rank() == 0) learners = slice.count();
  });
  learned += count;
  learning = learned < learners;
  return learning ? learners - learned : 0;
}

/// Status of the world: 0 while nothing is wrong.
HEDON_EXPORT(hedon_fault) int hedon_fault() { return report_fault(); }

/// Adds an agent or a food by hand: see `add_thing`.
HEDON_EXPORT(hedon_add) int hedon_add(int32_t type, float x, float y) {
  return need_rest() != 0 ? 1 : change(add_thing(world(), type, {x, y}));
}

/// Removes by hand what is at a place: see `remove_thing`.
HEDON_EXPORT(hedon_remove) int hedon_remove(float x, float y, float slack) {
  return need_rest() != 0 ? 1 : change(remove_thing(world(), {x, y}, slack));
}

/// Whether the world has been edited by hand: 1 if it can no longer be reproduced from its config and seed.
HEDON_EXPORT(hedon_edited) int hedon_edited() { return edited ? 1 : 0; }

/// Keeps a copy of the world as it is now, which replaces the previous copy.
HEDON_EXPORT(hedon_keep) int hedon_keep() {
  if (need_rest() != 0) return 1;
  const size_t bytes = static_cast<size_t>(simulation->bytes_per_world());
  if (!kept) kept.reset(static_cast<char*>(reserve_pages(bytes)));
  if (!kept) return fail("there is no memory left to keep the world");
  memcpy(kept.get(), simulation->memory(0), bytes);
  kept_edited = edited;
  return 0;
}

/// Restores the kept copy of the world, which continues with the same bits.
HEDON_EXPORT(hedon_return) int hedon_return() {
  if (!kept) return fail("no world was kept");
  memcpy(simulation->memory(0), kept.get(), static_cast<size_t>(simulation->bytes_per_world()));
  learning = false;
  edited = kept_edited;
  return report_fault();
}

/// The digest that `hedon run` gives for the same state. Do not call it while a window is being learned.
HEDON_EXPORT(hedon_digest) uint64_t hedon_digest() { return simulation->digest(0); }

/// Returns a buffer of `bytes` bytes for the name of an array.
HEDON_EXPORT(hedon_path) char* hedon_path(int32_t bytes) {
  path.assign(static_cast<size_t>(bytes), '\0');
  return path.data();
}

/// The location of the array named by `hedon_path`; null if there is none. Valid until the next world is made.
HEDON_EXPORT(hedon_view) const View* hedon_view() { return find_view() ? &view : nullptr; }

/// Index of the first food of a kind among the foods; for the number of kinds, the number of foods.
HEDON_EXPORT(hedon_food_start) int32_t hedon_food_start(int32_t kind) { return simulation->shape().food_offset[kind]; }

/// Whether this machine fuses multiply-adds: 1 if it gives the bits of AVX2 and AVX-512. `near` must be 1 + 2^-12.
HEDON_EXPORT(hedon_fuses) int hedon_fuses(float near) {
  // The square has a last bit, 2^-24, which only a fused multiply-add keeps.
  alignas(64) float rest[16];
  store(rest, multiply_add(broadcast(near), broadcast(near), broadcast(-(2.0f * near - 1.0f))));
  return rest[0] != 0.0f ? 1 : 0;
}

/// Clears the waiting deaths in the views `death_log.…`; call it after reading them.
HEDON_EXPORT(hedon_take_deaths) void hedon_take_deaths() {
  world().head().death_log_count = 0;
  world().head().death_log_lost = 0;
}

/// What the agent in `slot` senses now and its network's output, zeros if its species has none. Does not change the
/// world's state. Returns the addresses of the parts: readings and types of rays, the network's output, other
/// observations.
HEDON_EXPORT(hedon_probe) const void* const* hedon_probe(int32_t slot) {
  note_start(world(), slot);
  observe(world(), slot, 0, probe.observation);
  memset(probe.output, 0, sizeof probe.output);
  const FixedList<Channel, MAX_CHANNELS>& observed = world().species(slot).layout.observed;
  for (int32_t d = 0; d < observed.count; ++d)
    probe.observed[d] = read_channel(world(), slot, probe.observation, observed[d]);
  if (world().species(slot).has_network)
    world().kernel->network.forward(world().species(slot).network, world().network(slot), probe.observation,
                                    probe.output);
  return PROBED;
}

}  // namespace hedon
