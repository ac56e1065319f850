/// Many worlds with one config: their memory and threads, and how they advance together.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "base/team.h"
#include "simulation/checkpoint.h"
#include "simulation/device.h"
#include "simulation/memory.h"
#include "simulation/pace.h"
#include "simulation/window.h"
#include "world/world.h"

namespace hedon {

using PartSeconds = std::array<double, static_cast<size_t>(Part::count)>;

/// Agents and foods of a chosen scene; all arrays of agents have one length, all arrays of foods another.
struct SceneInput {
  Array<const float> x, y, angle, energy;
  Array<const int32_t> species;
  Array<const float> food_x, food_y;
  Array<const int32_t> food_kind;
};

/// The caller's arrays for the agents of one species: (worlds, slots of the species, …) each.
struct ObservationOut {
  float* observation;  ///< (…, entries); zeros for empty slots; null for `read_rewards`
  float* reward;       ///< in the last step, of the agent with the id from before it; else 0
  int32_t* agent_id;   ///< -1 for empty slots; on entry, the ids from before the step
};

/// The meaning of the numbers in a caller's actions.
enum class ActionForm : int32_t {
  unit,   ///< from -1, the least force of a motor, to 1, the greatest
  force,  ///< the force itself
  logit   ///< before the sigmoid, like the output of a network: any finite number
};

/// Bytes that a simulation reserves, by purpose. Memory that is never touched costs nothing.
struct MemoryNeed {
  int64_t networks;
  int64_t cold;      ///< moments of the optimizers, and observations, which may be in files
  int64_t rollouts;  ///< without the observations
  int64_t physics;
  int64_t rest;

  HEDON_FIELDS(MemoryNeed, networks, cold, rollouts, physics, rest)

  /// All bytes, or those that are not in files.
  int64_t total(bool in_files) const { return networks + (in_files ? 0 : cold) + rollouts + physics + rest; }
};

/// Floats of scratch for each thread that learns, in whole cache lines.
int64_t learn_stride(const WorldShape& shape, const Config& config);

/// Each call sets the floating-point mode that it needs and restores the caller's.
class Simulation {
 public:
  /// walls   outer polygon first, clockwise, then inner walls
  /// slot_order  the order in which slots are first handed out, empty for 0, 1, 2, …; it changes no result
  /// flush   whether denormals are flushed to zero; does not change results
  /// program  of the devices that advance the worlds, which are divided among them; null to use threads
  /// scratch  folder for files with cold data; empty to keep it in memory; does not change results
  /// The arguments must have passed `check_config` and `check_arguments`. Use the simulation only if `pool().whole()`
  /// is true and `scratch_error()` is 0.
  Simulation(const Config& config, std::vector<Segment> walls, int32_t outer_walls, const std::vector<uint64_t>& seeds,
             int threads, const Kernel* kernel, const std::vector<int32_t>& slot_order, bool flush = true,
             const DeviceProgram* program = nullptr, const std::string& scratch = "");

  /// Bytes that a simulation would reserve. Compare them with the machine's memory before you make one.
  static MemoryNeed bytes_needed(const Config& config, int32_t walls, int64_t worlds, int threads);

  /// Empties a world and puts these agents and foods into it, at any places, for tests of chosen scenes.
  /// Returns false if there are more than the world can hold.
  bool set_scene(int index, const SceneInput& scene);

  /// Everything that determines a world's future, as arrays. Deaths that the reader has not yet taken are not included.
  Checkpoint save(int index);
  void save(int index, const CheckpointSink& sink);

  /// Replaces a world by a saved one, which continues with the same bits. Returns "", or what is wrong with the
  /// checkpoint; then the world is unchanged.
  std::string restore(int index, const Checkpoint& checkpoint);

  /// Replaces all worlds and their seeds by saved ones, or none of them if one of the checkpoints is invalid.
  std::string restore(const std::vector<SavedWorld>& saved);

  /// Writes all worlds as one byte string with a text of the caller's, unless `out` is null; returns its length.
  size_t pack(std::string_view head, char* out);

  /// Begins a world again with this seed.
  void reset(int index, uint64_t seed);

  /// A hash of everything that determines a world's future: equal for equal bits.
  uint64_t digest(int index);

  /// Advances every world that is not over by `steps` steps. The results do not depend on threads.
  void run(int64_t steps);

  /// Gives a species a rule; required before a step if the config asks for one.
  void set_rule(int32_t species, RuleUse use, Rule rule);

  /// "", or the rule that the config requires but that is missing.
  std::string missing_rule() const;

  /// The index in (worlds, slots of the species, 2) of an invalid action of a living agent, or -1.
  int64_t wrong_action(int32_t species, const float* actions, ActionForm form) const;

  /// Sets the actions of the agents of an external species from now on: (worlds, slots of the species, 2). Rows without
  /// an agent are not read. Returns -1, or the index of an action out of bounds; then no action is set.
  int64_t set_actions(int32_t species, const float* actions, ActionForm form);

  /// Writes what the agents of an external species sense now, and their rewards in the last step. Returns the number of
  /// slots that now have another agent, or none.
  int64_t read_observations(int32_t species, const ObservationOut& out);

  /// The same without observations.
  void read_rewards(int32_t species, const ObservationOut& out);

  /// Writes the numbers of meals of a species since the worlds began: (worlds, meals).
  void count_meals(int32_t species, int64_t* out) const;

  int world_count() const { return static_cast<int>(worlds_.size()); }
  /// A world that the caller may change in every way.
  World& world(int index) {
    complete(index);
    if (Device* device = device_of(index)) device->change(index);
    return numbers(index);
  }
  /// A world that the caller may read completely.
  const World& complete(int index) {
    if (Device* device = device_of(index)) device->fetch(index);
    return numbers(index);
  }
  /// A world of which the caller changes only the head, and does not read networks and rollouts, which may be only on
  /// the device.
  World& numbers(int index) { return worlds_[static_cast<size_t>(index)]; }
  /// What went wrong on a device; "" if nothing did.
  std::string device_complaint() const;
  /// Summed over all devices, which work at the same time.
  DeviceSeconds device_seconds() const;
  int device_count() const { return static_cast<int>(devices_.size()); }
  const WorldShape& shape() const { return shape_; }
  const Config& config() const { return config_; }
  bool flush() const { return flush_; }
  /// 0, or the system's error number if the files in `scratch` could not be made.
  int scratch_error() const { return scratch_error_; }
  /// The name of the instruction set or of the device that advances the worlds.
  const char* kernel_name() const { return devices_.empty() ? kernel_->name : devices_[0]->program().name; }
  const Pool& pool() const { return *pool_; }
  Pool& pool() { return *pool_; }
  const PartSeconds& seconds(int index) const { return seconds_[static_cast<size_t>(index)]; }
  /// The block that contains a whole world, `bytes_per_world` long. Putting a copy of it back restores the world.
  char* memory(int index) { return memory_[static_cast<size_t>(index)].data(); }
  int64_t bytes_per_world() const { return memory_.empty() ? 0 : memory_.front().size(); }

 private:
  void begin(World& world);
  void empty(World& world);
  Device* device_of(int index) const;
  void advance_with(Team team, int thread, int world, int64_t steps);

  Config config_;
  WorldShape shape_;
  const Kernel* kernel_;
  bool flush_;
  int scratch_error_ = 0;
  std::vector<Segment> walls_;
  std::vector<int32_t> slot_order_;
  std::vector<Memory> memory_;
  std::vector<World> worlds_;
  std::vector<PartSeconds> seconds_;
  std::vector<Pace> paces_;
  Memory learn_scratch_;
  int64_t learn_stride_;
  std::unique_ptr<Pool> pool_;
  std::vector<std::unique_ptr<Device>> devices_;  ///< each has a range of the worlds; empty if threads advance them
};

}  // namespace hedon
