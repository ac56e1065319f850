/// A simulation for Python. All calls go through it, and invalid calls are refused with a message.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "binding/batch.h"
#include "simulation/simulation.h"

namespace hedon {

using WallsIn = nanobind::ndarray<const float, nanobind::shape<-1, 4>, nanobind::c_contig, nanobind::device::cpu>;

/// A rule of a species, with its name for messages.
struct NamedRule {
  int32_t species;
  RuleUse use;
  std::string name;
};

class PythonSimulation {
 public:
  /// The arguments are as for `Simulation`; 0 threads for all processors, "" for the best kernel.
  /// device   file of the library of a device that advances the worlds; "" for the threads
  /// scratch   folder for files with cold data; "" to keep it in memory
  /// EngineError: a number is out of bounds, the kernel is unknown, there is too little memory, or there is no place
  /// for the initial agents or foods; or the device cannot be used.
  PythonSimulation(nanobind::dict config, WallsIn walls, int64_t outer_walls, const std::vector<uint64_t>& seeds,
                   int threads, const std::string& kernel, const std::vector<int32_t>& slot_order, bool flush_denormals,
                   const std::string& device, const std::string& scratch);

  ~PythonSimulation();
  PythonSimulation(const PythonSimulation&) = delete;
  PythonSimulation& operator=(const PythonSimulation&) = delete;

  /// A number that no other simulation of this process has, or has had.
  int64_t id() const { return id_; }

  /// Calls use(simulation) for the simulation with this id, from any thread, without Python; it is not destroyed
  /// meanwhile. Returns the result of `use`, or why it could not be called.
  static std::string with(int64_t id, const std::function<std::string(PythonSimulation&)>& use);

  /// The turn of the state from which `step_batch` continues; a copy of an environment takes it over from the original.
  uint32_t turn() const { return turn_; }
  void set_turn(uint32_t turn) { turn_ = turn; }

  /// See `hedon::step_batch`.
  std::string step_batch(const BatchCall& call, const BatchIn& in, const BatchOut& out, int64_t rows);

  /// Calls the `Watch` of a call, if it has one. EngineError: its complaint.
  void tell(const BatchCall& call, Watched watched, const bool* begins = nullptr, const uint64_t* seeds = nullptr);

  static int count_threads(int threads) { return threads > 0 ? threads : available_processors(); }

  /// EngineError: it runs in another thread, or this process was forked from the one that made it.
  Simulation& get();

  /// The same, and IndexError: there is no such world. For worlds on a device, networks and rollouts may be outdated:
  /// see `Simulation::numbers`.
  World& world(int index);

  /// Brings a world's networks and rollouts to the host. EngineError: the device that had them has failed.
  void need_whole(int index);

  /// A world with consistent slots. EngineError: it stopped because its slots are inconsistent.
  World& slotted(int index);

  /// Replaces all worlds by the ones in a string from `Simulation::pack`. Returns "", or why none was replaced.
  std::string unpack(std::string_view bytes);

  /// `Simulation::set_rule`; the messages of the rule's faults contain its name.
  void set_rule(NamedRule named, Rule rule);

  /// Begins a world again with this seed. EngineError: there is no place for its initial agents or foods.
  void reset(int index, uint64_t seed);

  /// `Simulation::read_observations`, or `read_rewards`, which counts nothing, if there is no array of observations.
  /// The interpreter lock is released.
  int64_t read_observations(int32_t species, const ObservationOut& out);

  /// Advances all worlds. After each piece, a fraction of a second long, Python handles signals, so that Ctrl-C raises
  /// KeyboardInterrupt. The worlds are then in a valid state, after fewer steps.
  /// EngineError: also for the fault of a world.
  void run(int64_t steps);

 private:
  int faulty() const;  ///< the world with the first fault; -1 if there is none
  void raise_faults();
  std::string about_agents(const Fault& fault) const;
  std::string begin_alike(const BatchCall& call, const BatchIn& in, const BatchOut& out);
  void need_working();

  std::unique_ptr<Simulation> simulation_;
  std::atomic<bool> running_{false};
  std::atomic<std::thread::id> watcher_{};  ///< the thread in which a `Watch` reads, while all others wait
  int64_t id_ = 0;
  std::vector<NamedRule> rules_;
  uint32_t
      turn_;  ///< counts calls of `step_batch` from a start of its own, so that states of other simulations are refused
  std::optional<uint32_t> alike_;  ///< the turn at which all worlds began with one seed
  int64_t piece_ = 1;              ///< steps between two checks for Ctrl-C
};

/// A world config from a nested dict. EngineError: a number is out of bounds.
Config need_config(nanobind::dict config);

}  // namespace hedon
