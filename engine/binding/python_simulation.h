/// A simulation as Python holds it: one door for all calls, at which a caller that cannot be served is refused by name.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace hedon {

using WallsIn = nanobind::ndarray<const float, nanobind::shape<-1, 4>, nanobind::c_contig, nanobind::device::cpu>;

class PythonSimulation {
 public:
  /// Arguments as `Simulation` has them; 0 threads for all processors, "" for the best kernel.
  /// EngineError: a number is out of bounds, the kernel is unknown, there is too little memory, or nothing finds a
  /// place.
  PythonSimulation(nanobind::dict config, WallsIn walls, int64_t outer_walls, const std::vector<uint64_t>& seeds,
                   int threads, const std::string& kernel, const std::vector<int32_t>& slot_order,
                   bool flush_denormals);

  static int count_threads(int threads) { return threads > 0 ? threads : available_processors(); }

  /// EngineError: it runs in another thread, or this process was forked from the one that made it.
  Simulation& get();

  /// The same, and IndexError: there is no such world.
  World& world(int index);

  /// A world whose slots can be relied upon; one that stopped since they could not be is not read by them.
  World& slotted(int index);

  /// Advances all worlds. Between pieces of a fraction of a second Python handles signals, so that Ctrl-C raises
  /// KeyboardInterrupt; the worlds are whole then, after fewer steps.
  /// EngineError: also what a world reports.
  void run(int64_t steps);

 private:
  void raise_faults();

  std::unique_ptr<Simulation> simulation_;
  std::atomic<bool> running_{false};
  int64_t piece_ = 1;  ///< steps between two looks at the keyboard
};

/// A world config from a nested dict. EngineError: a number is out of bounds.
WorldConfig need_config(nanobind::dict config);

}  // namespace hedon
