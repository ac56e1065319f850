/// Worlds on a device with its own memory: their layout there, and the program that advances them.
///
/// A `DeviceProgram` is the interface of a device's library: CUDA's or, in tests, the emulation's. `Device` holds
/// copies of a simulation's worlds. All readers still use the host's worlds: small data is copied back after each call,
/// but networks and rollouts, which make up most of a world, only on request.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/memory.h"
#include "world/world.h"

namespace hedon {

/// How many lists of circles a world on a device has room for: one for each tile of a block.
inline constexpr int DEVICE_MEMBERS = 32;

/// The arguments of a device's kernels; all pointers are device pointers.
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

/// The kernels of a window, for timing.
enum class DevicePart : int32_t { step, learn, close, count };
inline constexpr int32_t DEVICE_PARTS = static_cast<int32_t>(DevicePart::count);
inline constexpr const char* DEVICE_PART_NAMES[] = {"step", "learn", "close"};

/// Functions of a library for devices of one kind. Those that return a text return "" or what went wrong.
struct DeviceProgram {
  const char* name;
  uint64_t layout;                  ///< `device_layout()` of the sources it was built from
  int32_t widest_network;           ///< inputs of the widest network that it can update
  const char* (*open)();            ///< finds the devices
  int32_t (*count)();               ///< number of devices, after `open`
  void (*use)(int32_t device);      ///< selects the device for the following calls of this thread
  const char* (*describe)();        ///< a JSON object that describes the device and the resources of its kernels
  int32_t (*learners_at_once)();    ///< blocks of updates that run concurrently
  void* (*reserve)(int64_t bytes);  ///< null if there is too little memory
  void (*release)(void* block);
  const char* (*copy_in)(void* to, const void* from, int64_t bytes);
  const char* (*copy_out)(void* to, const void* from, int64_t bytes);
  const char* (*fill_kernel)(Kernel* kernel);
  const char* (*advance)(const DeviceWorlds& worlds, int64_t step, int64_t steps);  ///< starts without waiting
  const char* (*finish)(double* seconds);  ///< waits; adds the seconds of each `DevicePart` since the last call
};

/// The function `hedon_device` that such a library exports.
using DeviceEntry = const DeviceProgram* (*)();

/// A number that differs if the library and the engine were built from sources with different data layouts.
constexpr uint64_t device_layout() {
  uint64_t sum = 0;
  for (const size_t size : {sizeof(World), sizeof(WorldState), sizeof(WorldShape), sizeof(Config), sizeof(Kernel),
                            sizeof(DeviceWorlds), sizeof(DeviceProgram), sizeof(PhysicsScratch)})
    sum = sum * 1009 + size;
  return sum;
}

/// Seconds of the kernels, and of copies in either direction.
struct DeviceSeconds {
  double kernel[DEVICE_PARTS];
  double copying;
};

class Device {
 public:
  /// Copies the worlds [first, last), of one config, to the device with this number; each is in one block of memory.
  /// `complaint` reports whether that failed.
  Device(const DeviceProgram& program, int32_t number, std::vector<World>& worlds, const std::vector<Memory>& memory,
         int first, int last);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Whether an array of the state is one of the networks and rollouts.
  static constexpr bool is_large(ArrayShape size) {
    return size.lifetime == Lifetime::rollout || size.width == Extent::params || size.width == Extent::pairs ||
           size.width == Extent::hidden;
  }

  const DeviceProgram& program() const { return program_; }
  const DeviceSeconds& seconds() const { return seconds_; }

  /// "", or what went wrong. In that case the host's worlds stay as they were after the last run, without their
  /// networks.
  const std::string& complaint() const { return complaint_; }

  bool holds(int index) const { return index >= first_ && index < last_; }

  /// Starts to advance all worlds that are not over; all of them are at the same step.
  void start(int64_t steps);

  /// Waits for that; afterwards the host has all small data.
  void finish();

  /// Brings a world's networks and rollouts to the host, unless they are there already.
  void fetch(int index);

  /// Marks a world as changed by the host, including networks and rollouts, so that the next run copies all of it.
  void change(int index) { changed_[at(index)] = true; }

 private:
  /// Which arrays are copied together.
  enum class Kind : uint8_t {
    head,       ///< the host may change it between any two runs
    small,      ///< read after each run
    death_log,  ///< the same, of which only the rows in use are copied
    large       ///< networks and rollouts: copied on request
  };

  /// A part of a world's memory.
  struct Piece {
    int64_t first, bytes;
    int64_t row;  ///< bytes of a row of the death log
    Kind kind;
  };

  size_t at(int index) const { return static_cast<size_t>(index - first_); }
  World& world(int index) const { return worlds_[static_cast<size_t>(index)]; }
  const Memory& memory(int index) const { return memory_[static_cast<size_t>(index)]; }
  char* home(int index) const { return blocks_[at(index)]; }
  void list_pieces();
  void place(int index);
  void copy_in(int index, bool all);
  void copy_out(int index, Kind kind);
  void note(const char* problem);

  const DeviceProgram& program_;
  const int32_t number_;
  std::vector<World>& worlds_;
  const std::vector<Memory>& memory_;
  const int first_, last_;
  std::vector<Piece> pieces_;
  std::vector<char*> blocks_;  ///< each world's memory on the device
  char* common_ = nullptr;     ///< config, shape, table, worlds
  char* learning_ = nullptr;   ///< bootstrap values and scratch
  DeviceWorlds on_{};
  std::vector<bool> changed_;  ///< by the host
  std::vector<bool> fetched_;  ///< the host has the networks and rollouts of this moment
  bool running_ = false;
  DeviceSeconds seconds_{};
  std::string complaint_;
};

}  // namespace hedon
