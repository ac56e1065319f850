#include "simulation/device.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace hedon {
namespace {

/// Offsets in the block that all worlds share.
struct Common {
  int64_t config = 0;
  int64_t shape = up(config + static_cast<int64_t>(sizeof(Config)));
  int64_t kernel = up(shape + static_cast<int64_t>(sizeof(WorldShape)));
  int64_t worlds = up(kernel + static_cast<int64_t>(sizeof(Kernel)));

  static int64_t up(int64_t bytes) { return (bytes + Memory::ALIGNMENT - 1) / Memory::ALIGNMENT * Memory::ALIGNMENT; }
};

/// Calls visit(array) for all arrays of a world.
template <class Visit>
void for_each_world_array(World& world, Visit&& visit) {
  const auto each = [&](const std::string&, auto& array) { visit(array); };
  for_each_array(world.state, "", each);
  for_each_array(world.physics_scratch, "", each);
  for_each_array(world.scratch, "", each);
  for_each_array(world.scene, "", each);
}

/// Floats of scratch of one update: advantages, targets, and for each epoch an order and two lists.
int64_t update_scratch(const Config& config) {
  int64_t most = 0;
  for (int32_t s = 0; s < config.species.count; ++s) {
    const LearningConfig& learning = config.species[s].learning;
    most = std::max(most, static_cast<int64_t>(config.world.rollout_steps) * (2 + 3 * learning.update_epochs));
  }
  return (most + 15) / 16 * 16;
}

/// Adds its lifetime to a sum.
class Timer {
 public:
  explicit Timer(double& sum) : sum_(sum), begun_(std::chrono::steady_clock::now()) {}
  ~Timer() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count(); }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace

Device::Device(const DeviceProgram& program, int32_t number, std::vector<World>& worlds,
               const std::vector<Memory>& memory, int first, int last)
    : program_(program),
      number_(number),
      worlds_(worlds),
      memory_(memory),
      first_(first),
      last_(last),
      blocks_(static_cast<size_t>(last - first)),
      changed_(blocks_.size(), true),
      fetched_(blocks_.size(), true) {
  program_.use(number_);
  const WorldShape& shape = *worlds[0].shape;
  const Config& config = *worlds[0].config;
  const Common at;
  const int64_t count = last - first;
  const int64_t stride = update_scratch(config);
  on_.learners_at_once = program.learners_at_once();
  const int64_t values = (count * shape.capacity + 15) / 16 * 16;
  const int64_t floats = values + stride * on_.learners_at_once;
  common_ = static_cast<char*>(program.reserve(at.worlds + count * static_cast<int64_t>(sizeof(World))));
  learning_ = static_cast<char*>(program.reserve(floats * static_cast<int64_t>(sizeof(float))));
  bool all = common_ != nullptr && learning_ != nullptr;
  for (int i = first; i < last && all; ++i) {
    blocks_[this->at(i)] = static_cast<char*>(program.reserve(this->memory(i).size()));
    all = home(i) != nullptr;
  }
  if (!all) {
    complaint_ = "the device has too little memory for these worlds: use fewer seeds, or lower population.capacity";
    return;
  }
  on_.worlds = reinterpret_cast<World*>(common_ + at.worlds);
  on_.kernel = reinterpret_cast<Kernel*>(common_ + at.kernel);
  on_.bootstrap = reinterpret_cast<float*>(learning_);
  on_.scratch = on_.bootstrap + values;
  on_.scratch_stride = stride;
  on_.count = static_cast<int32_t>(count);
  on_.window = shape.steps;
  on_.learning = shape.learning;
  on_.species = shape.species;
  for (int32_t s = 0; s < shape.species; ++s) on_.params[s] = shape.of[s].learns ? shape.of[s].network.size() : 0;

  note(program.copy_in(common_ + at.config, &config, sizeof config));
  note(program.copy_in(common_ + at.shape, &shape, sizeof shape));
  note(program.fill_kernel(on_.kernel));
  list_pieces();
  for (int i = first; i < last; ++i) place(i);
}

Device::~Device() {
  program_.use(number_);
  for (char* block : blocks_) {
    if (block != nullptr) program_.release(block);
  }
  if (common_ != nullptr) program_.release(common_);
  if (learning_ != nullptr) program_.release(learning_);
}

void Device::note(const char* problem) {
  if (complaint_.empty()) complaint_ = problem;
}

/// The pieces of the state that the host reads and writes between runs, with adjacent ones merged. Data needed only
/// within a step stays on the device.
void Device::list_pieces() {
  World& world = this->world(first_);
  const char* const base = memory(first_).data();
  const auto add = [&](const auto& array, Kind kind, int64_t row) {
    const int64_t first = reinterpret_cast<const char*>(array.data) - base, bytes = laid_out_bytes(array);
    if (array.count == 0) return;
    const bool joins = kind != Kind::death_log && !pieces_.empty() && pieces_.back().kind == kind &&
                       pieces_.back().first + pieces_.back().bytes == first;
    if (joins)
      pieces_.back().bytes += bytes;
    else
      pieces_.push_back({first, bytes, row, kind});
  };
  WorldState::for_each_shape([&](const char* name, auto member, ArrayShape size) {
    auto& field = world.state.*member;
    if constexpr (IsArray<std::remove_cvref_t<decltype(field)>>::value) {
      const bool log = is_by_death(size.rows);
      const int64_t rows = world.shape->death_log_rows;
      const Kind kind = strcmp(name, "head") == 0 ? Kind::head
                        : log                     ? Kind::death_log
                        : is_large(size)          ? Kind::large
                                                  : Kind::small;
      add(field, kind, log ? field.count / rows * static_cast<int64_t>(sizeof field[0]) : 0);
    } else {
      for_each_array(field, "", [&](const std::string&, auto& array) { add(array, Kind::small, 0); });
    }
  });
}

/// Writes the device's version of a world, and its whole memory, including data needed only within a step.
void Device::place(int index) {
  const Common at;
  World there = world(index);
  const int64_t shift = home(index) - memory(index).data();
  for_each_world_array(there, [&]<class T>(Array<T>& array) {
    array.data = reinterpret_cast<T*>(reinterpret_cast<char*>(array.data) + shift);
  });
  for (auto& uses : there.rule) {
    for (Rule& rule : uses) rule = nullptr;
  }
  there.config = reinterpret_cast<const Config*>(common_ + at.config);
  there.shape = reinterpret_cast<const WorldShape*>(common_ + at.shape);
  there.kernel = on_.kernel;
  note(program_.copy_in(on_.worlds + this->at(index), &there, sizeof there));
  note(program_.copy_in(home(index), memory(index).data(), memory(index).size()));
}

/// all   if false, only the parts that the host may change without notice
void Device::copy_in(int index, bool all) {
  for (const Piece& piece : pieces_) {
    if (all || piece.kind == Kind::head)
      note(program_.copy_in(home(index) + piece.first, memory(index).data() + piece.first, piece.bytes));
  }
}

/// Copies the pieces of a kind. Of the death log, it copies the rows that the head counts, so the head must be copied
/// first.
void Device::copy_out(int index, Kind kind) {
  for (const Piece& piece : pieces_) {
    if (piece.kind != kind) continue;
    int64_t bytes = piece.bytes;
    if (kind == Kind::death_log)
      bytes = piece.row * std::clamp(world(index).head().death_log_count, 0, world(index).shape->death_log_rows);
    if (bytes > 0) note(program_.copy_out(memory(index).data() + piece.first, home(index) + piece.first, bytes));
  }
}

void Device::start(int64_t steps) {
  running_ = false;
  if (!complaint_.empty()) return;
  program_.use(number_);
  int64_t step = -1;
  {
    const Timer timer(seconds_.copying);
    for (int i = first_; i < last_; ++i) {
      copy_in(i, changed_[at(i)]);
      changed_[at(i)] = false;
      if (world(i).over()) continue;
      if (step >= 0 && world(i).head().step != step) note("the worlds on a device must all be at the same step");
      step = world(i).head().step;
    }
  }
  if (step < 0 || !complaint_.empty()) return;
  note(program_.advance(on_, step, steps));
  running_ = true;
}

void Device::finish() {
  if (!running_) return;
  program_.use(number_);
  note(program_.finish(seconds_.kernel));
  if (!complaint_.empty()) return;
  const Timer timer(seconds_.copying);
  for (int i = first_; i < last_; ++i) {
    for (const Kind kind : {Kind::head, Kind::small, Kind::death_log}) copy_out(i, kind);
    fetched_[at(i)] = false;
  }
}

void Device::fetch(int index) {
  if (fetched_[at(index)] || !complaint_.empty()) return;
  program_.use(number_);
  const Timer timer(seconds_.copying);
  copy_out(index, Kind::large);
  fetched_[at(index)] = true;
}

}  // namespace hedon
