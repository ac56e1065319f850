#include "simulation/simulation.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>

#include "base/float_mode.h"
#include "world/obstacle.h"
#include "world/population.h"

namespace hedon {
namespace {

/// Adds the time since the last lap to a part. It only reads the clock, so nothing in a world depends on it.
class Stopwatch {
 public:
  explicit Stopwatch(PartSeconds* seconds) : seconds_(seconds), last_(std::chrono::steady_clock::now()) {}

  void operator()(Part part) {
    if (seconds_ == nullptr) return;
    const auto now = std::chrono::steady_clock::now();
    (*seconds_)[static_cast<size_t>(part)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  PartSeconds* seconds_;
  std::chrono::steady_clock::time_point last_;
};

struct WorldBytes {
  int64_t all;
  int64_t warm;  ///< arrays before the cold ones
};

/// Places all arrays of a world from `at` on, unless `at` is null, with the cold ones last, on separate pages.
WorldBytes lay_out_world(World& world, char* at) {
  int64_t bytes = 0;
  const auto next = [&] { return at == nullptr ? nullptr : at + bytes; };
  bytes += lay_out_some(world.state, next(), [](ArrayShape size) { return !is_cold(size); });
  bytes += lay_out(world.physics_scratch, next());
  bytes += lay_out(world.scratch, next());
  bytes += lay_out(world.scene, next());
  const int64_t warm = bytes = (bytes + Memory::SMALL_PAGE - 1) / Memory::SMALL_PAGE * Memory::SMALL_PAGE;
  bytes += lay_out_some(world.state, next(), is_cold);
  return {bytes, warm};
}

/// Prefetches the cold data of a world shortly before it is read, if it is in a file.
struct Cold {
  const Memory& memory;
  const World& world;

  void rollout(int32_t slot) const {
    const Array<ObservationLine>& seen = world.state.observation;
    const int64_t lines = seen.count / world.shape->capacity;
    memory.expect(&seen[slot * lines], lines * static_cast<int64_t>(sizeof(ObservationLine)));
  }
  /// For agents that have learned before this window. Their counts of updates show this too, but others write these
  /// now.
  void moments(int32_t slot) const {
    const int64_t before = world.head().step - 2 * world.shape->steps;
    if (!world.species(slot).learns || world.state.life[slot].birth_step > before) return;
    const Learner learner = learner_of(world, slot);
    const int64_t bytes = world.shape->params * static_cast<int64_t>(sizeof(float));
    memory.expect(learner.first_moment, bytes);
    memory.expect(learner.second_moment, bytes);
  }
};

}  // namespace

int64_t learn_stride(const WorldShape& shape, const Config& config) {
  int64_t most = 0;
  for (int32_t s = 0; s < shape.species; ++s)
    most = std::max(most, learn_scratch_size(shape.of[s].network, config.species[s].learning, shape.steps));
  return (most + 15) / 16 * 16;
}

Simulation::Simulation(const Config& config, std::vector<Segment> walls, int32_t outer_walls,
                       const std::vector<uint64_t>& seeds, int threads, const Kernel* kernel,
                       const std::vector<int32_t>& slot_order, bool flush, const DeviceProgram* program,
                       const std::string& scratch)
    : config_(config),
      kernel_(kernel),
      flush_(flush),
      walls_(std::move(walls)),
      slot_order_(slot_order),
      worlds_(seeds.size()),
      seconds_(seeds.size()),
      paces_(seeds.size()) {
  const FloatMode mode(flush_);
  shape_ = make_shape(config_, static_cast<int32_t>(walls_.size()), outer_walls);
  for (size_t i = 0; i < worlds_.size(); ++i) {
    World& world = worlds_[i];
    world.config = &config_;
    world.shape = &shape_;
    world.kernel = kernel_;
    world.seed = seeds[i];
    set_counts(world, program == nullptr ? threads : std::max(threads, DEVICE_MEMBERS));
    const WorldBytes bytes = lay_out_world(world, nullptr);
    memory_.emplace_back(bytes.all);
    if (!scratch.empty()) scratch_error_ = memory_.back().keep_in_file(bytes.warm, scratch);
    if (scratch_error_ != 0) break;
    lay_out_world(world, memory_.back().data());
    begin(world);
    if (!world.over()) init_population(world);
  }
  learn_stride_ = learn_stride(shape_, config_);
  learn_scratch_ = Memory(learn_stride_ * static_cast<int64_t>(sizeof(float)) * threads);
  pool_ = std::make_unique<Pool>(threads, flush_);  // last, since starting threads takes memory too
  if (program == nullptr || !pool_->whole() || scratch_error_ != 0) return;
  const int worlds = world_count(), devices = std::min(program->count(), worlds);
  for (int d = 0; d < devices; ++d)
    devices_.push_back(
        std::make_unique<Device>(*program, d, worlds_, memory_, worlds * d / devices, worlds * (d + 1) / devices));
}

Device* Simulation::device_of(int index) const {
  for (const std::unique_ptr<Device>& device : devices_) {
    if (device->holds(index)) return device.get();
  }
  return nullptr;
}

std::string Simulation::device_complaint() const {
  for (const std::unique_ptr<Device>& device : devices_) {
    if (!device->complaint().empty()) return device->complaint();
  }
  return "";
}

DeviceSeconds Simulation::device_seconds() const {
  DeviceSeconds sum{};
  for (const std::unique_ptr<Device>& device : devices_) {
    const DeviceSeconds& seconds = device->seconds();
    for (int32_t part = 0; part < DEVICE_PARTS; ++part) sum.kernel[part] += seconds.kernel[part];
    sum.copying += seconds.copying;
  }
  return sum;
}

MemoryNeed Simulation::bytes_needed(const Config& config, int32_t walls, int64_t worlds, int threads) {
  const FloatMode mode;
  const WorldShape shape = make_shape(config, walls, walls);
  World world{};
  world.config = &config;
  world.shape = &shape;
  set_counts(world, threads);
  const auto bytes = [](const auto&... arrays) { return (laid_out_bytes(arrays) + ...); };
  const WorldState& state = world.state;
  const WorldBytes all = lay_out_world(world, nullptr);
  const int64_t networks = bytes(state.params, state.folded_bias, state.packed_weights);
  const int64_t rollouts = bytes(state.action, state.log_prob, state.value, state.reward);
  const int64_t physics = lay_out(world.state.physics, nullptr) + lay_out(world.physics_scratch, nullptr);
  const int64_t rest = all.warm - networks - rollouts - physics;
  const int64_t learning = threads * learn_stride(shape, config) * static_cast<int64_t>(sizeof(float));
  return {worlds * networks, worlds * (all.all - all.warm), worlds * rollouts, worlds * physics,
          worlds * rest + learning};
}

/// Makes zeroed memory an empty world: all slots free, no agent, no food.
void Simulation::begin(World& world) {
  WorldHead& head = world.head();
  head.extinct_step = -1;
  for (int32_t slot = shape_.capacity - 1; slot >= 0; --slot)
    give_back_slot(world, slot_order_.empty() ? slot : slot_order_[static_cast<size_t>(slot)]);
  for (int32_t slot = 0; slot < shape_.capacity && shape_.own; ++slot)
    world.state.own[slot] = shape_.of[shape_.species_of(slot)];
  for (int64_t slot = 0; slot < world.state.physics.shape.count; ++slot)
    world.state.physics.shape[slot] = world.state.own[slot].body;
  for (int64_t f = 0; f < shape_.foods; ++f) world.scratch.eater[f] = -1;
  init_physics(world.state.physics, world_physics_capacity(world));
  world.state.physics.outer_walls = shape_.outer_walls;
  for (size_t w = 0; w < walls_.size(); ++w) world.state.physics.walls[static_cast<int64_t>(w)] = walls_[w];
  place_obstacles(world);
  for (int32_t w = 0; w < shape_.walls; ++w) {
    const Segment& wall = world.state.physics.walls[w];
    world.scene.wall_ax[w] = wall.a.x;
    world.scene.wall_ay[w] = wall.a.y;
    world.scene.wall_bx[w] = wall.b.x;
    world.scene.wall_by[w] = wall.b.y;
  }
}

/// Removes everything from a world.
void Simulation::empty(World& world) {
  const auto clear = []<class T>(const std::string&, Array<T>& array) {
    memset(static_cast<void*>(array.data), 0, static_cast<size_t>(array.count) * sizeof(T));
  };
  WorldState::for_each_shape([&](const char* name, auto member, ArrayShape size) {
    auto& field = world.state.*member;
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, PhysicsState>) {
      for_each_array(field, "", clear);
    } else if (!Device::is_large(size) && size.rows != Extent::learner_slots) {
      // The rest may stay: an agent that takes a slot gets new networks, rollouts and a new optimizer.
      clear(name, field);
    }
  });
  begin(world);
}

void Simulation::reset(int index, uint64_t seed) {
  const FloatMode mode(flush_);
  World& target = world(index);
  target.seed = seed;
  empty(target);
  if (!target.over()) init_population(target);
}

bool Simulation::set_scene(int index, const SceneInput& scene) {
  const FloatMode mode(flush_);
  World& target = world(index);
  if (scene.x.count > shape_.capacity) return false;
  std::vector<int32_t> count(static_cast<size_t>(shape_.kinds));
  for (int64_t f = 0; f < scene.food_kind.count; ++f) {
    const int32_t kind = scene.food_kind[f];
    if (kind < 0 || kind >= shape_.kinds || ++count[static_cast<size_t>(kind)] > config_.food[kind].capacity)
      return false;
  }
  empty(target);
  for (int64_t i = 0; i < scene.x.count; ++i) {
    const int32_t species = scene.species[i];
    if (species < 0 || species >= shape_.species || target.state.free_count[species] == 0) return false;
    spawn_founder(target, species, {scene.x[i], scene.y[i]}, scene.angle[i], scene.energy[i]);
  }
  if (inherits_late(target)) fill_vacancies(target);
  open_window(target);
  for (int64_t f = 0; f < scene.food_kind.count; ++f) {
    place_food(target, scene.food_kind[f], {scene.food_x[f], scene.food_y[f]});
  }
  for (int32_t k = 0; k < shape_.kinds; ++k) target.state.food_stock[k].number = target.state.food_stock[k].present;
  if (scene.x.count == 0) target.head().extinct_step = 0;
  return true;
}

void Simulation::advance_with(Team team, int thread, int world, int64_t steps) {
  // Members of a team use consecutive scratch, beginning at the first member's place.
  float* scratch = reinterpret_cast<float*>(learn_scratch_.data()) + (thread - team.rank()) * learn_stride_;
  Stopwatch lap(team.rank() == 0 ? &seconds_[static_cast<size_t>(world)] : nullptr);
  Pace& pace = paces_[static_cast<size_t>(world)];
  const auto pacer = [&](Team& members, int64_t count, auto&& step_once) {
    return step_at_pace(members, pace, count, step_once);
  };
  World& here = worlds_[static_cast<size_t>(world)];
  const Cold cold{memory_[static_cast<size_t>(world)], here};
  advance(team, here, steps, scratch, learn_stride_, pacer, lap, cold);
}

void Simulation::run(int64_t steps) {
  if (!devices_.empty()) {
    for (const std::unique_ptr<Device>& device : devices_) device->start(steps);
    for (const std::unique_ptr<Device>& device : devices_) device->finish();
    return;
  }
  std::vector<int> going;
  for (int i = 0; i < world_count(); ++i) {
    if (!numbers(i).over()) going.push_back(i);
  }
  const int threads = pool_->size();
  const int count = static_cast<int>(going.size());
  if (count == 0) return;
  for (const int i : going) {
    const Array<ObservationLine>& old = numbers(i).state.observation;
    if (numbers(i).head().step % shape_.steps == 0)
      memory_[static_cast<size_t>(i)].forget(old.data, old.count * static_cast<int64_t>(sizeof(ObservationLine)));
  }
  // The largest number of worlds that divides evenly over all threads runs with one thread per world; teams of threads
  // step the remaining worlds.
  const int alone = count / threads * threads;
  const int shared = count - alone;
  std::atomic<int> next{0};
  std::deque<TeamState> single(static_cast<size_t>(threads));
  std::deque<TeamState> teams(static_cast<size_t>(shared));
  const auto first_thread = [&](int team) { return team * threads / shared; };
  for (int team = 0; team < shared; ++team)
    teams[static_cast<size_t>(team)].size = first_thread(team + 1) - first_thread(team);

  const FloatMode mode(flush_);
  pool_->run([&](int thread) {
    for (int i = next.fetch_add(1); i < alone; i = next.fetch_add(1)) {
      advance_with(Team(single[static_cast<size_t>(thread)], 0), thread, going[static_cast<size_t>(i)], steps);
    }
    for (int team = 0; team < shared; ++team) {
      const int first = first_thread(team);
      if (thread < first || thread >= first_thread(team + 1)) continue;
      advance_with(Team(teams[static_cast<size_t>(team)], thread - first), thread,
                   going[static_cast<size_t>(alone + team)], steps);
    }
  });
}

}  // namespace hedon
