#include "binding/python_simulation.h"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <thread>

#include "base/float_mode.h"
#include "base/platform.h"
#include "binding/config.h"
#include "binding/device.h"
#include "binding/error.h"
#include "binding/released.h"
#include "simulation/config_check.h"
#include "simulation/pack.h"

namespace nb = nanobind;

namespace hedon {
namespace {

constexpr double PIECE_SECONDS =
    0.2;  ///< longest time between two checks for Ctrl-C, except for the learning of a window

const Kernel* need_kernel(const std::string& name) {
  const Kernel* kernel = find_kernel(name.c_str());
  if (kernel != nullptr) return kernel;
  std::string known;
  for (const char* const* at = kernel_names(); *at != nullptr; ++at)
    known += std::string(known.empty() ? "" : ", ") + *at;
  throw EngineError("kernel '" + name + "' is unknown or not for this processor, which can run: " + known);
}

/// Refuses a simulation that does not fit into this machine's memory, before any memory is reserved.
void need_memory(const Config& config, size_t walls, size_t worlds, int threads, bool in_files) {
  const MemoryNeed need =
      Simulation::bytes_needed(config, static_cast<int32_t>(walls), static_cast<int64_t>(worlds), threads);
  const double needed = static_cast<double>(need.total(in_files));
  const double present = static_cast<double>(physical_memory());
  if (needed > present) {
    char text[200];
    snprintf(text, sizeof text,
             "the worlds need %.1f GB of memory, and this machine has %.1f GB: lower population.capacity, "
             "world.rollout_steps or the number of seeds%s",
             needed / 1e9, present / 1e9, in_files ? "" : ", or set HEDON_SCRATCH to a folder");
    throw EngineError(text);
  }
  // A limit on addresses (ulimit -v) shows only when memory is reserved; files have addresses too.
  const size_t bytes = static_cast<size_t>(need.total(false)) + worlds * static_cast<size_t>(Memory::PAGE);
  void* const probe = reserve_pages(bytes);
  if (probe == nullptr)
    throw EngineError("the system refuses memory for the worlds, though there is enough: check the limit `ulimit -v`");
  release_pages(probe, bytes);
}

std::vector<Segment> to_segments(const WallsIn& walls) {
  std::vector<Segment> segments;
  for (size_t i = 0; i < walls.shape(0); ++i)
    segments.push_back({{walls(i, 0), walls(i, 1)}, {walls(i, 2), walls(i, 3)}});
  return segments;
}

/// The simulations of this process by id. One that a thread uses without Python is not destroyed meanwhile.
struct Registry {
  std::mutex mutex;
  std::map<int64_t, PythonSimulation*> held;
  int64_t last = 0;
};

Registry& registry() {
  static Registry all;
  return all;
}

/// Marks a simulation as free again at the end of a call, also after an exception.
struct Running {
  std::atomic<bool>& mark;
  ~Running() { mark.store(false); }
};

void need(const std::string& complaint) {
  if (!complaint.empty()) throw EngineError(complaint);
}

}  // namespace

Config need_config(nb::dict config) {
  const FloatMode mode;
  const Config known = to_config<Config>(config);
  need(check_config(known));
  return known;
}

PythonSimulation::PythonSimulation(nb::dict config, WallsIn walls, int64_t outer_walls,
                                   const std::vector<uint64_t>& seeds, int threads, const std::string& kernel,
                                   const std::vector<int32_t>& slot_order, bool flush_denormals,
                                   const std::string& device, const std::string& scratch) {
  const FloatMode mode;
  const Config known = need_config(config);
  const std::vector<Segment> segments = to_segments(walls);
  const int used = count_threads(threads);
  need(check_arguments(known, segments, outer_walls, static_cast<int64_t>(seeds.size()), used, slot_order));
  need_memory(known, segments.size(), seeds.size(), used, !scratch.empty());
  const DeviceProgram* const program = device.empty() ? nullptr : need_device(device, known);
  simulation_ = std::make_unique<Simulation>(known, segments, static_cast<int32_t>(outer_walls), seeds, used,
                                             need_kernel(kernel), slot_order, flush_denormals, program, scratch);
  if (simulation_->scratch_error() != 0)
    throw EngineError("HEDON_SCRATCH: no file for these worlds can be made in '" + scratch +
                      "': " + strerror(simulation_->scratch_error()));
  if (!simulation_->pool().whole())
    throw EngineError("the system gives no " + std::to_string(used) +
                      " threads: use fewer, or check the limits `ulimit -u` and `ulimit -v`");
  raise_faults();
  need_working();
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  id_ = ++all.last;
  turn_ = static_cast<uint32_t>(static_cast<uint64_t>(id_) * 0x9E3779B9u);  // far from the turns of other simulations
  all.held[id_] = this;
}

PythonSimulation::~PythonSimulation() {
  Registry& all = registry();
  {
    const std::lock_guard lock(all.mutex);
    all.held.erase(id_);
  }
  while (running_.load()) std::this_thread::yield();  // a thread without Python is still at work; no other can start
}

std::string PythonSimulation::with(int64_t id, const std::function<std::string(PythonSimulation&)>& use) {
  Registry& all = registry();
  PythonSimulation* found = nullptr;
  {
    const std::lock_guard lock(all.mutex);
    const auto at = all.held.find(id);
    if (at == all.held.end()) return "the worlds are gone: keep the environment for as long as its programs run";
    if (at->second->running_.exchange(true)) return "busy: the simulation is running in another thread";
    found = at->second;
  }
  const Running mark{found->running_};
  return use(*found);
}

Simulation& PythonSimulation::get() {
  if (simulation_->pool().forked())
    throw EngineError(
        "this process was forked from the one that made the simulation, and the simulation's threads do not exist "
        "here: make a new simulation in this process");
  if (running_.load() && watcher_.load() != std::this_thread::get_id())
    throw EngineError("busy: the simulation is running in another thread");
  return *simulation_;
}

World& PythonSimulation::world(int index) {
  Simulation& simulation = get();
  if (index < 0 || index >= simulation.world_count()) throw nb::index_error("no world has this index");
  return simulation.numbers(index);
}

void PythonSimulation::need_working() {
  const std::string complaint = simulation_->device_complaint();
  if (complaint.empty()) return;
  throw EngineError("device '" + std::string(simulation_->kernel_name()) + "': " + complaint);
}

void PythonSimulation::need_whole(int index) {
  world(index);
  simulation_->complete(index);
  need_working();
}

World& PythonSimulation::slotted(int index) {
  World& from = world(index);
  if (from.fault().status == Status::slots_inconsistent) throw EngineError("the world's slots are inconsistent");
  return from;
}

void PythonSimulation::run(int64_t steps) {
  using Clock = std::chrono::steady_clock;
  Simulation& simulation = get();
  const std::string missing = simulation.missing_rule();
  if (!missing.empty()) throw EngineError(missing);
  if (steps < 0) throw EngineError("steps = " + std::to_string(steps) + ": must be at least 0");
  if (running_.exchange(true)) throw EngineError("busy: the simulation is running in another thread");
  const Running mark{running_};
  while (steps > 0) {
    // A device is not interrupted within a window.
    const int64_t count = std::min(simulation.device_count() > 0 ? simulation.shape().steps : piece_, steps);
    const Clock::time_point begun = Clock::now();
    {
      const Released released;
      simulation.run(count);
    }
    steps -= count;
    raise_faults();
    need_working();
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    // Approach the full time by at most a factor of four, since the time of a piece with learning hardly predicts the
    // next.
    const double next = static_cast<double>(count) * PIECE_SECONDS / std::max(seconds, 1e-9);
    if (count == piece_) piece_ = static_cast<int64_t>(std::clamp(next, 1.0, 4.0 * static_cast<double>(piece_)));
  }
}

std::string PythonSimulation::unpack(std::string_view bytes) {
  const Packed packed = hedon::unpack(bytes, false);
  return packed.complaint.empty() ? get().restore(packed.worlds) : packed.complaint;
}

void PythonSimulation::reset(int index, uint64_t seed) {
  world(index);
  get().reset(index, seed);
  raise_faults();
}

int64_t PythonSimulation::read_observations(int32_t species, const ObservationOut& out) {
  Simulation& simulation = get();
  if (running_.exchange(true)) throw EngineError("busy: the simulation is running in another thread");
  const Running mark{running_};
  const Released released;
  if (out.observation != nullptr) return simulation.read_observations(species, out);
  simulation.read_rewards(species, out);
  return 0;
}

void PythonSimulation::set_rule(NamedRule named, Rule rule) {
  get().set_rule(named.species, named.use, rule);
  rules_.push_back(std::move(named));
}

/// The agents of a fault, or the agent and the rule that caused it.
std::string PythonSimulation::about_agents(const Fault& fault) const {
  std::string text = fault.agent_id >= 0 ? ", agent " + std::to_string(fault.agent_id) : "";
  const bool ruled = fault.status == Status::rule_not_finite || fault.status == Status::rule_no_chance ||
                     fault.status == Status::rule_wrote;
  if (!ruled) return fault.other_id >= 0 ? text + ", with agent " + std::to_string(fault.other_id) : text;
  for (const NamedRule& each : rules_)
    if (each.species * RULE_USES + static_cast<int32_t>(each.use) == fault.other_id) text += ", " + each.name;
  return text;
}

static std::string shown(double value) {
  char text[40];
  snprintf(text, sizeof text, "%g", value);
  return text;
}

/// The only place that turns a world's status into an exception: the earliest error, whatever the number of steps.
int PythonSimulation::faulty() const {
  Simulation& simulation = *simulation_;
  int first = -1;
  for (int i = 0; i < simulation.world_count(); ++i) {
    const Fault& fault = simulation.numbers(i).fault();
    if (fault.status != Status::ok && (first < 0 || fault.step < simulation.numbers(first).fault().step)) first = i;
  }
  return first;
}

void PythonSimulation::raise_faults() {
  Simulation& simulation = *simulation_;
  const int first = faulty();
  if (first < 0) return;
  const Fault& fault = simulation.numbers(first).fault();
  const StatusText& text = STATUS_TEXT[static_cast<int>(fault.status)];
  std::string message = std::string(text.name) + ": " + text.sentence + " World " + std::to_string(first) + ", step " +
                        std::to_string(fault.step) + ", value " + shown(fault.value) + about_agents(fault);
  message += ", windows completed: " + std::to_string(fault.step / simulation.shape().steps);
  throw EngineError(message + ". " + text.remedy);
}

}  // namespace hedon
