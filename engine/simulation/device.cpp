#include "simulation/device.h"

#include <algorithm>
#include <cstring>

namespace hedon {
namespace {

/// Where things lie in the block that all worlds share.
struct Common {
  int64_t config = 0;
  int64_t shape = up(config + static_cast<int64_t>(sizeof(WorldConfig)));
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

/// Floats of scratch of one update: see `block_scratch_size`.
int64_t update_scratch(const WorldConfig& config) {
  int64_t most = 0;
  for (int32_t s = 0; s < config.species.count; ++s) {
    const LearningConfig& learning = config.species[s].learning;
    most = std::max(most, static_cast<int64_t>(learning.rollout_steps) * (2 + 3 * learning.update_epochs));
  }
  return (most + 15) / 16 * 16;
}

}  // namespace

Device::Device(const DeviceProgram& program, std::vector<World>& worlds, const std::vector<Memory>& memory)
    : program_(program),
      worlds_(worlds),
      memory_(memory),
      blocks_(worlds.size()),
      changed_(worlds.size(), true),
      fetched_(worlds.size(), true) {
  const WorldShape& shape = *worlds[0].shape;
  const WorldConfig& config = *worlds[0].config;
  const Common at;
  const int64_t count = static_cast<int64_t>(worlds.size());
  const int64_t stride = update_scratch(config);
  on_.learners_at_once = program.learners_at_once();
  const int64_t values = (count * shape.capacity + 15) / 16 * 16;
  const int64_t floats = values + stride * on_.learners_at_once;
  common_ = static_cast<char*>(program.reserve(at.worlds + count * static_cast<int64_t>(sizeof(World))));
  learning_ = static_cast<char*>(program.reserve(floats * static_cast<int64_t>(sizeof(float))));
  bool all = common_ != nullptr && learning_ != nullptr;
  for (size_t i = 0; i < worlds.size() && all; ++i) {
    blocks_[i] = static_cast<char*>(program.reserve(memory[i].size()));
    all = blocks_[i] != nullptr;
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

  WorldShape there = shape;
  for (int32_t s = 0; s < shape.species; ++s)
    there.of[s].config = reinterpret_cast<const WorldConfig*>(common_ + at.config)->species.items + s;
  note(program.copy_in(common_ + at.config, &config, sizeof config));
  note(program.copy_in(common_ + at.shape, &there, sizeof there));
  note(program.fill_kernel(on_.kernel));
  list_pieces(worlds[0]);
  for (size_t i = 0; i < worlds.size(); ++i) place(static_cast<int>(i));
}

Device::~Device() {
  for (char* block : blocks_) {
    if (block != nullptr) program_.release(block);
  }
  if (common_ != nullptr) program_.release(common_);
  if (learning_ != nullptr) program_.release(learning_);
}

void Device::note(const char* problem) {
  if (complaint_.empty()) complaint_ = problem;
}

/// The pieces of the state that the host reads and writes between runs; neighboring ones as one. What only a step
/// needs stays on the device.
void Device::list_pieces(World& world) {
  const char* const base = memory_[0].data();
  const auto add = [&](const auto& array, bool large) {
    const int64_t first = reinterpret_cast<const char*>(array.data) - base, bytes = laid_out_bytes(array);
    if (!pieces_.empty() && pieces_.back().large == large && pieces_.back().first + pieces_.back().bytes == first)
      pieces_.back().bytes += bytes;
    else
      pieces_.push_back({first, bytes, large});
  };
  WorldState::for_each_shape([&](const char*, auto member, ArrayShape size) {
    auto& field = world.state.*member;
    if constexpr (IsArray<std::remove_cvref_t<decltype(field)>>::value)
      add(field, is_large(size));
    else
      for_each_array(field, "", [&](const std::string&, auto& array) { add(array, false); });
  });
}

/// Writes the device's version of a world, and its whole memory: also of what only a step needs.
void Device::place(int index) {
  const Common at;
  const size_t i = static_cast<size_t>(index);
  World there = worlds_[i];
  const int64_t shift = home(index) - memory_[i].data();
  for_each_world_array(there, [&]<class T>(Array<T>& array) {
    array.data = reinterpret_cast<T*>(reinterpret_cast<char*>(array.data) + shift);
  });
  for (auto& uses : there.rule) {
    for (Rule& rule : uses) rule = nullptr;
  }
  there.config = reinterpret_cast<const WorldConfig*>(common_ + at.config);
  there.shape = reinterpret_cast<const WorldShape*>(common_ + at.shape);
  there.kernel = on_.kernel;
  note(program_.copy_in(on_.worlds + index, &there, sizeof there));
  note(program_.copy_in(home(index), memory_[i].data(), memory_[i].size()));
}

void Device::copy(int index, bool in, bool small, bool large) {
  char* const here = memory_[static_cast<size_t>(index)].data();
  for (const Piece& piece : pieces_) {
    if (!(piece.large ? large : small)) continue;
    char* const there = home(index) + piece.first;
    note(in ? program_.copy_in(there, here + piece.first, piece.bytes)
            : program_.copy_out(here + piece.first, there, piece.bytes));
  }
}

void Device::run(int64_t steps) {
  int64_t step = -1;
  for (size_t i = 0; i < worlds_.size(); ++i) {
    copy(static_cast<int>(i), true, true, changed_[i]);
    changed_[i] = false;
    if (worlds_[i].over()) continue;
    if (step >= 0 && worlds_[i].head().step != step) note("the worlds on a device must all be at the same step");
    step = worlds_[i].head().step;
  }
  if (step < 0 || !complaint_.empty()) return;
  note(program_.advance(on_, step, steps));
  for (size_t i = 0; i < worlds_.size(); ++i) {
    copy(static_cast<int>(i), false, true, false);
    fetched_[i] = false;
  }
}

void Device::fetch(int index) {
  if (fetched_[static_cast<size_t>(index)]) return;
  copy(index, false, false, true);
  fetched_[static_cast<size_t>(index)] = true;
}

}  // namespace hedon
