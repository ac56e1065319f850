/// Worlds on a device with memory of its own: where they lie there, and who advances them.
///
/// A `DeviceProgram` is what a library of a device offers: CUDA's, or in tests the emulation's. `Device` keeps the
/// copies of a simulation's worlds. The host's worlds stay what everyone reads: after each call, what is small is
/// copied back; networks and rollouts, which are most of a world, only when somebody wants them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/memory.h"
#include "world/world.h"

namespace hedon {

/// Rooms that a world on a device has for lists of circles: one for each tile of a block.
inline constexpr int DEVICE_MEMBERS = 16;

/// What the kernels of a device get; all pointers are the device's.
struct DeviceWorlds {
  World* worlds;
  Kernel* kernel;
  float* bootstrap;  ///< (worlds, capacity)
  float* scratch;    ///< (learners_at_once, scratch_stride)
  int64_t scratch_stride;
  int32_t learners_at_once;
  int32_t count;
  int64_t window;
  bool learning;
  int32_t species;
  int32_t params[MAX_SPECIES];  ///< of the networks of each species; 0 if it has none
};

/// Functions of a library for a device. Those that return a text return "" or what went wrong.
struct DeviceProgram {
  const char* name;
  uint64_t layout;                  ///< `device_layout()` of the sources that it was built from
  int32_t widest_network;           ///< inputs of the widest network that its updates can hold
  const char* (*open)();            ///< finds the device
  int32_t (*learners_at_once)();    ///< blocks of updates that run side by side
  void* (*reserve)(int64_t bytes);  ///< null if there is too little memory
  void (*release)(void* block);
  const char* (*copy_in)(void* to, const void* from, int64_t bytes);
  const char* (*copy_out)(void* to, const void* from, int64_t bytes);
  const char* (*fill_kernel)(Kernel* kernel);
  const char* (*advance)(const DeviceWorlds& worlds, int64_t step, int64_t steps);
};

/// The function `hedon_device` that such a library exports.
using DeviceEntry = const DeviceProgram* (*)();

/// A number that differs where the library and the engine come from sources with other data.
constexpr uint64_t device_layout() {
  uint64_t sum = 0;
  for (const size_t size : {sizeof(World), sizeof(WorldState), sizeof(WorldShape), sizeof(WorldConfig), sizeof(Kernel),
                            sizeof(DeviceWorlds), sizeof(DeviceProgram), sizeof(PhysicsScratch)})
    sum = sum * 1009 + size;
  return sum;
}

class Device {
 public:
  /// Copies worlds of one config to the device; each lies in one block of memory. `complaint` says if that failed.
  Device(const DeviceProgram& program, std::vector<World>& worlds, const std::vector<Memory>& memory);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Whether an array of the state is one of the networks and rollouts.
  static constexpr bool is_large(ArrayShape size) {
    return size.lifetime == Lifetime::rollout || size.width == Extent::params || size.width == Extent::pairs ||
           size.width == Extent::hidden;
  }

  const DeviceProgram& program() const { return program_; }
  const std::string& complaint() const { return complaint_; }

  /// Advances all worlds that are not over; they are all at the same step. Then the host has all that is small.
  void run(int64_t steps);

  /// Brings a world's networks and rollouts to the host, unless they are there already.
  void fetch(int index);

  /// Says that the host changes a world, networks and rollouts included: the next run copies all of it.
  void change(int index) { changed_[static_cast<size_t>(index)] = true; }

 private:
  /// A part of a world's memory.
  struct Piece {
    int64_t first, bytes;
    bool large;  ///< networks and rollouts
  };

  void list_pieces(World& world);
  void place(int index);
  void copy(int index, bool in, bool small, bool large);
  void note(const char* problem);
  char* home(int index) const { return blocks_[static_cast<size_t>(index)]; }

  const DeviceProgram& program_;
  std::vector<World>& worlds_;
  const std::vector<Memory>& memory_;
  std::vector<Piece> pieces_;
  std::vector<char*> blocks_;  ///< each world's memory on the device
  char* common_ = nullptr;     ///< config, shape, table, worlds
  char* learning_ = nullptr;   ///< bootstrap values and scratch
  DeviceWorlds on_{};
  std::vector<bool> changed_;  ///< by the host
  std::vector<bool> fetched_;  ///< the host has the networks and rollouts of this moment
  std::string complaint_;
};

}  // namespace hedon
