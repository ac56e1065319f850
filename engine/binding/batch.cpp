#include "binding/batch.h"

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "binding/python_simulation.h"

namespace hedon {
namespace {

/// Begins a world again, by the seed in its row.
void begin_world(Simulation& simulation, const BatchIn& in, int row) {
  const uint64_t seed = uint64_t{in.key[2 * row]} << 32 | in.key[2 * row + 1];
  simulation.reset(row, seed);
}

std::string number(const char* name, int64_t world, int64_t slot, int64_t motor, double value) {
  char text[160];
  snprintf(text, sizeof text, "%s[%lld, %lld, %lld] = %g: is not an action of this form", name,
           static_cast<long long>(world), static_cast<long long>(slot), static_cast<long long>(motor), value);
  return text;
}

/// One agent-step after the other, with the rewards of those who were there at the beginning.
void advance_worlds(Simulation& simulation, const BatchCall& call, const BatchIn& in, const BatchOut& out,
                    size_t agents) {
  const int32_t species = static_cast<int32_t>(call.species);
  std::vector<float> paid(agents);
  std::vector<int32_t> acting(agents);
  memcpy(out.ids, in.ids, agents * sizeof(int32_t));
  memset(out.rewards, 0, agents * sizeof(float));
  for (int64_t i = 0; i < call.repeat; ++i) {
    memcpy(acting.data(), out.ids, agents * sizeof(int32_t));
    simulation.run(1);
    simulation.read_rewards(species, {nullptr, paid.data(), out.ids});
    for (size_t a = 0; a < agents; ++a) out.rewards[a] += acting[a] == in.ids[a] ? paid[a] : 0.0f;
  }
  for (size_t a = 0; a < agents; ++a) out.terminated[a] = in.ids[a] >= 0 && in.ids[a] != out.ids[a];
}

}  // namespace

std::string PythonSimulation::step_batch(const BatchCall& call, const BatchIn& in, const BatchOut& out, int64_t rows) {
  Simulation& simulation = *simulation_;
  const int64_t worlds = simulation.world_count();
  if (simulation.pool().forked()) return "this process was forked from the one that made the worlds";
  if (rows != worlds)
    return "called for " + std::to_string(rows) + " worlds, and there are " + std::to_string(worlds) +
           ": use jax.vmap over all of them at once";
  const Species& own = simulation.shape().of[call.species];
  const size_t slots = static_cast<size_t>(own.capacity()), agents = slots * static_cast<size_t>(rows);
  const size_t entries = static_cast<size_t>(own.network.observation.size());
  if (call.slots != own.capacity() || call.entries != static_cast<int64_t>(entries))
    return "compiled for other worlds: trace the program again";
  for (int64_t i = 0; i < rows && call.begins == 0; ++i) {
    if (in.world[i] != i) return "the states are not in the order of the worlds";
    if (in.turn[i] != turn_)
      return "stale state: a later step or reset has used its worlds, or they are those of another environment; go on "
             "with the state that was returned last";
  }
  if (call.begins == 0) {
    std::vector<float> paid(agents);
    std::vector<int32_t> living(agents);
    simulation.read_rewards(static_cast<int32_t>(call.species), {nullptr, paid.data(), living.data()});
    if (memcmp(living.data(), in.ids, agents * sizeof(int32_t)) != 0)
      return "agent_id: is not that of the state that was returned last";
  }
  memset(out.observations, 0, agents * entries * sizeof(float));
  if (call.begins != 0) {
    memset(out.rewards, 0, agents * sizeof(float));
    memset(out.terminated, 0, agents * sizeof(bool));
  } else {
    const int64_t bad =
        simulation.set_actions(static_cast<int32_t>(call.species), in.actions, static_cast<ActionForm>(call.form));
    if (bad >= 0) {
      const int64_t wide = static_cast<int64_t>(slots) * ACTIONS;
      return number("action", bad / wide, bad % wide / ACTIONS, bad % ACTIONS, static_cast<double>(in.actions[bad]));
    }
    advance_worlds(simulation, call, in, out, agents);
    raise_faults();
  }
  ++turn_;
  for (int64_t i = 0; i < rows; ++i) {
    int32_t* const ids = out.ids + i * static_cast<int64_t>(slots);
    bool left = false;
    for (size_t s = 0; s < slots; ++s) left |= ids[s] >= 0;
    const bool late = call.max_steps > 0 && simulation.numbers(static_cast<int>(i)).head().step >= call.max_steps;
    out.done[i] = call.begins == 0 && (late || !left);
    if (call.begins != 0 || out.done[i]) {
      begin_world(simulation, in, static_cast<int>(i));
      for (size_t s = 0; s < slots; ++s) ids[s] = -1;
    }
    out.world[i] = static_cast<int32_t>(i);
    out.turn[i] = turn_;
  }
  raise_faults();
  std::vector<float> paid(agents);
  simulation.read_observations(static_cast<int32_t>(call.species), {out.observations, paid.data(), out.ids});
  return "";
}

void step_batch(const BatchCall* call, const BatchIn* in, const BatchOut* out, int64_t rows, char* complaint,
                int64_t room) noexcept {
  std::string said;
  try {
    said = PythonSimulation::with(call->simulation,
                                  [&](PythonSimulation& held) { return held.step_batch(*call, *in, *out, rows); });
  } catch (const std::exception& error) {
    said = error.what();
  }
  snprintf(complaint, static_cast<size_t>(room), "%s", said.c_str());
}

}  // namespace hedon
