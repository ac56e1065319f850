#include "binding/batch.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "binding/error.h"
#include "binding/python_simulation.h"

namespace hedon {
namespace {

/// The seed in the row of a world, without the upper bit, which the records of a run cannot store.
uint64_t seed_in(const BatchIn& in, int64_t row) {
  return uint64_t{in.key[2 * row] & 0x7fffffffu} << 32 | in.key[2 * row + 1];
}

std::string number(const char* name, int64_t world, int64_t slot, int64_t motor, double value) {
  char text[160];
  snprintf(text, sizeof text, "%s[%lld, %lld, %lld] = %g: is not an action of this form", name,
           static_cast<long long>(world), static_cast<long long>(slot), static_cast<long long>(motor), value);
  return text;
}

/// Runs the steps one after another, with rewards for the agents that were alive at the beginning.
void advance_worlds(PythonSimulation& held, Simulation& simulation, const BatchCall& call, const BatchIn& in,
                    const BatchOut& out, size_t agents) {
  const int32_t species = static_cast<int32_t>(call.species);
  std::vector<float> paid(agents);
  std::vector<int32_t> acting(agents);
  memcpy(out.ids, in.ids, agents * sizeof(int32_t));
  memset(out.rewards, 0, agents * sizeof(float));
  for (int64_t i = 0; i < call.repeat; ++i) {
    memcpy(acting.data(), out.ids, agents * sizeof(int32_t));
    held.tell(call, Watched::BEFORE_STEP);
    simulation.run(1);
    held.tell(call, Watched::AFTER_STEP);
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
  if (call.begins != 0 && rows == 1 && worlds > 1) return begin_alike(call, in, out);
  if (rows != worlds)
    return "called for " + std::to_string(rows) + " worlds, and there are " + std::to_string(worlds) +
           ": use jax.vmap over all of them at once";
  const Species& own = simulation.shape().of[call.species];
  const size_t slots = static_cast<size_t>(own.capacity()), agents = slots * static_cast<size_t>(rows);
  const size_t entries = static_cast<size_t>(own.network.observation.size());
  if (call.slots != own.capacity() || call.entries != static_cast<int64_t>(entries))
    return "compiled for other worlds: trace the program again";
  for (int64_t i = 0; i < rows && call.begins == 0; ++i) {
    if (in.world[i] != i && !(alike_ == turn_ && in.world[i] == 0))
      return "the states are not in the order of the worlds";
    if (in.turn[i] != turn_)
      return "stale state: a later step or reset has used its worlds, or they belong to another environment; continue "
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
    advance_worlds(*this, simulation, call, in, out, agents);
    raise_faults();
  }
  ++turn_;
  std::vector<uint64_t> seeds(static_cast<size_t>(rows));
  const std::unique_ptr<bool[]> begins(new bool[static_cast<size_t>(rows)]);
  bool any = false;
  for (int64_t i = 0; i < rows; ++i) {
    const int32_t* const ids = out.ids + i * static_cast<int64_t>(slots);
    const bool left = call.begins == 0 && std::any_of(ids, ids + slots, [](int32_t id) { return id >= 0; });
    const int64_t step = simulation.numbers(static_cast<int>(i)).head().step;
    const bool late = in.max_steps[i] > 0 && step >= in.max_steps[i];
    out.done[i] = call.begins == 0 && (late || !left);
    begins[static_cast<size_t>(i)] = call.begins != 0 || out.done[i];
    any |= begins[static_cast<size_t>(i)];
    seeds[static_cast<size_t>(i)] = seed_in(in, i);
    out.world[i] = static_cast<int32_t>(i);
    out.turn[i] = turn_;
  }
  if (any) tell(call, Watched::BEGIN, begins.get(), seeds.data());
  for (int64_t i = 0; i < rows; ++i) {
    if (!begins[static_cast<size_t>(i)]) continue;
    simulation.reset(static_cast<int>(i), seeds[static_cast<size_t>(i)]);
    std::fill_n(out.ids + i * static_cast<int64_t>(slots), slots, -1);
  }
  raise_faults();
  std::vector<float> paid(agents);
  simulation.read_observations(static_cast<int32_t>(call.species), {out.observations, paid.data(), out.ids});
  return "";
}

/// With one row for all worlds, they begin with the same seed. The rows of later steps may then all name world 0, for
/// example if a program maps many networks over a single world.
std::string PythonSimulation::begin_alike(const BatchCall& call, const BatchIn& in, const BatchOut& out) {
  const size_t worlds = static_cast<size_t>(simulation_->world_count());
  const size_t slots = static_cast<size_t>(call.slots), numbers = slots * static_cast<size_t>(call.entries);
  std::vector<uint32_t> key, turn(worlds);
  for (size_t i = 0; i < worlds; ++i) key.insert(key.end(), in.key, in.key + 2);
  const std::vector<int32_t> max_steps(worlds, in.max_steps[0]);
  std::vector<int32_t> world(worlds), ids(worlds * slots);
  std::vector<float> observations(worlds * numbers), rewards(worlds * slots);
  const std::unique_ptr<bool[]> terminated(new bool[worlds * slots]), done(new bool[worlds]);
  const BatchIn every{nullptr, nullptr, key.data(), nullptr, nullptr, max_steps.data()};
  const BatchOut told{world.data(),   turn.data(),      ids.data(), observations.data(),
                      rewards.data(), terminated.get(), done.get()};
  std::string said = step_batch(call, every, told, static_cast<int64_t>(worlds));
  if (!said.empty()) return said;
  alike_ = turn_;
  out.world[0] = 0;
  out.turn[0] = turn_;
  std::copy_n(ids.begin(), slots, out.ids);
  std::copy_n(observations.begin(), numbers, out.observations);
  std::fill_n(out.rewards, slots, 0.0f);
  std::fill_n(out.terminated, slots, false);
  out.done[0] = false;
  return said;
}

void PythonSimulation::tell(const BatchCall& call, Watched watched, const bool* begins, const uint64_t* seeds) {
  if (call.watch == 0) return;
  if (watched == Watched::AFTER_STEP && faulty() >= 0) watched = Watched::FAULT;
  char complaint[600] = "";
  watcher_.store(std::this_thread::get_id());
  const int32_t wrong = reinterpret_cast<Watch>(static_cast<uintptr_t>(call.watch))(
      static_cast<int32_t>(watched), begins, seeds, complaint, sizeof complaint);
  watcher_.store({});
  if (wrong != 0) throw EngineError(complaint);
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
