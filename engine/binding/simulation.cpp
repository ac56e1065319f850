/// `_engine.Simulation`: many worlds, advanced with the interpreter lock released, and read as NumPy arrays.
#include "simulation/simulation.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <set>
#include <string>

#include "binding/checkpoint.h"
#include "binding/config.h"
#include "binding/parts.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using FloatsIn = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IntsIn = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using WallsIn = nb::ndarray<const float, nb::shape<-1, 4>, nb::c_contig, nb::device::cpu>;

/// A copy with its own memory, as a NumPy array.
template <class T>
nb::object copy_array(std::vector<T> values, std::vector<size_t> shape) {
  auto* held = new std::vector<T>(std::move(values));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(held->data(), shape.size(), shape.data(), owner));
}

/// Rows of lives as a dict of columns.
nb::dict columns(const Life* life, const int32_t* eaten, const float* genome, const std::vector<int64_t>& rows,
                 const WorldShape& shape) {
  nb::dict out;
  Life::for_each_field([&](const char* name, auto member) {
    using Field = std::remove_cvref_t<decltype(life->*member)>;
    std::vector<Field> column(rows.size());
    for (size_t i = 0; i < rows.size(); ++i) column[i] = life[rows[i]].*member;
    out[name] = copy_array(std::move(column), {rows.size()});
  });
  const auto table = [&]<class T>(const T* data, int32_t width) {
    std::vector<T> values;
    values.reserve(rows.size() * static_cast<size_t>(width));
    for (const int64_t row : rows) values.insert(values.end(), data + row * width, data + (row + 1) * width);
    return copy_array(std::move(values), {rows.size(), static_cast<size_t>(width)});
  };
  out["eaten"] = table(eaten, shape.kinds);
  out["genome"] = table(genome, shape.genome.size());
  return out;
}

template <class Struct>
nb::dict to_dict(const Struct& values) {
  nb::dict out;
  Struct::for_each_field([&](const char* name, auto member) { out[name] = values.*member; });
  return out;
}

/// A simulation that refuses a second caller while it runs, and that raises what its worlds report.
class PythonSimulation {
 public:
  PythonSimulation(nb::dict config, WallsIn walls, int32_t outer_walls, const std::vector<uint64_t>& seeds, int threads,
                   const std::string& kernel, const std::vector<int32_t>& slot_order)
      : simulation_(need_memory(to_config<WorldConfig>(config), walls.shape(0), seeds.size(), count_threads(threads)),
                    to_segments(walls), outer_walls, seeds, count_threads(threads), need_kernel(kernel), slot_order) {
    raise_faults();
  }

  Simulation& get() { return simulation_; }

  static int count_threads(int threads) { return threads > 0 ? threads : available_processors(); }

  World& world(int index) {
    if (index < 0 || index >= simulation_.world_count()) throw nb::index_error("no world of that index");
    if (running_.load()) throw std::runtime_error("busy: the simulation is running in another thread");
    return simulation_.world(index);
  }

  void run(int64_t steps) {
    if (steps < 0) throw nb::value_error("steps: at least 0");
    if (simulation_.pool().forked())
      throw std::runtime_error("this process was forked from the simulation's; make a new one");
    if (running_.exchange(true)) throw std::runtime_error("busy: the simulation is running in another thread");
    {
      const nb::gil_scoped_release release;
      simulation_.run(steps);
    }
    running_.store(false);
    raise_faults();
  }

  void restore(int index, const nb::dict& arrays) {
    world(index);
    const std::string complaint = simulation_.restore(index, from_arrays(arrays));
    if (!complaint.empty()) throw nb::value_error(complaint.c_str());
  }

  /// A world whose slots can be relied upon; one that stopped since they could not be is not read by them.
  World& slotted(int index) {
    World& from = world(index);
    if (from.fault().status == Status::slots_inconsistent)
      throw std::runtime_error("the world's slots are inconsistent");
    return from;
  }

  nb::dict take_rows(int index) {
    World& from = world(index);
    const int32_t waiting = std::clamp(from.clock().event_count, 0, from.shape->events);
    std::vector<int64_t> rows(static_cast<size_t>(waiting));
    for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int64_t>(i);
    nb::dict out =
        columns(from.state.event.data, from.state.event_eaten.data, from.state.event_genome.data, rows, *from.shape);
    from.clock().event_count = 0;
    return out;
  }

  nb::dict living_rows(int index) {
    const World& from = slotted(index);
    std::vector<int64_t> rows;
    for (int32_t i = 0; i < from.clock().living_count; ++i) rows.push_back(from.state.living[i]);
    return columns(from.state.life.data, from.state.eaten.data, from.state.genome.data, rows, *from.shape);
  }

  /// Full observations of the living, in their order, from the state as it is now.
  nb::object observations(int index) {
    World& from = slotted(index);
    const ObservationShape& shape = from.shape->network.observation;
    const size_t count = static_cast<size_t>(from.clock().living_count), size = static_cast<size_t>(shape.size());
    std::vector<float> full(count * size);
    gather_scene(from);
    for (size_t i = 0; i < count; ++i) {
      const int32_t slot = from.state.living[static_cast<int64_t>(i)];
      note_start(from, slot);
      unpack(shape, observe(from, slot, 0), &full[i * size]);
    }
    return copy_array(std::move(full), {count, size});
  }

  void set_scene(int index, FloatsIn x, FloatsIn y, FloatsIn angle, FloatsIn energy, FloatsIn food_x, FloatsIn food_y,
                 IntsIn food_kind) {
    world(index);
    const size_t agents = x.shape(0), foods = food_x.shape(0);
    if (y.shape(0) != agents || angle.shape(0) != agents || energy.shape(0) != agents || food_y.shape(0) != foods ||
        food_kind.shape(0) != foods) {
      throw nb::value_error("the arrays of agents, and those of foods, have one length each");
    }
    const auto view = []<class T>(const T& array) {
      return Array<const typename T::Scalar>{array.data(), static_cast<int64_t>(array.shape(0))};
    };
    if (!simulation_.set_scene(
            index, {view(x), view(y), view(angle), view(energy), view(food_x), view(food_y), view(food_kind)})) {
      throw nb::value_error("more agents than slots, or more foods of a kind than its capacity, or an unknown kind");
    }
  }

 private:
  static const Kernel* need_kernel(const std::string& name) {
    const Kernel* kernel = find_kernel(name.c_str());
    if (kernel != nullptr) return kernel;
    std::string known;
    for (const char* const* at = kernel_names(); *at != nullptr; ++at)
      known += std::string(known.empty() ? "" : ", ") + *at;
    throw nb::value_error(
        ("kernel '" + name + "' is unknown or not for this processor, which can run: " + known).c_str());
  }

  /// Refuses what this machine cannot hold, before anything is reserved.
  static WorldConfig need_memory(const WorldConfig& config, size_t walls, size_t worlds, int threads) {
    const MemoryNeed need =
        Simulation::bytes_needed(config, static_cast<int32_t>(walls), static_cast<int64_t>(worlds), threads);
    const double needed = static_cast<double>(need.networks + need.rollouts + need.physics + need.rest);
    const double present = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (needed > present) {
      char text[160];
      snprintf(text, sizeof text,
               "the worlds need %.1f GB of memory, and this machine has %.1f GB: lower population.capacity, "
               "learning.rollout_steps or the number of seeds",
               needed / 1e9, present / 1e9);
      throw nb::value_error(text);
    }
    // A limit on addresses (ulimit -v) shows only when they are asked for.
    const size_t bytes = static_cast<size_t>(needed) + worlds * static_cast<size_t>(Memory::PAGE);
    void* probe = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (probe == MAP_FAILED)
      throw nb::value_error("the system gives the worlds no memory, though there is enough: look at `ulimit -v`");
    munmap(probe, bytes);
    return config;
  }

  static std::vector<Segment> to_segments(const WallsIn& walls) {
    std::vector<Segment> segments;
    for (size_t i = 0; i < walls.shape(0); ++i)
      segments.push_back({{walls(i, 0), walls(i, 1)}, {walls(i, 2), walls(i, 3)}});
    return segments;
  }

  /// The one place that turns a world's status into an exception: the earliest, however many steps were run at once.
  void raise_faults() {
    int first = -1;
    for (int i = 0; i < simulation_.world_count(); ++i) {
      const Fault& fault = simulation_.world(i).fault();
      if (fault.status != Status::ok && (first < 0 || fault.step < simulation_.world(first).fault().step)) first = i;
    }
    if (first >= 0) {
      const Fault& fault = simulation_.world(first).fault();
      const StatusText& text = STATUS_TEXT[static_cast<int>(fault.status)];
      std::string message = std::string(text.name) + ": " + text.sentence + " World " + std::to_string(first) +
                            ", step " + std::to_string(fault.step) + ", value " + std::to_string(fault.value);
      if (fault.agent_id >= 0) message += ", agent " + std::to_string(fault.agent_id);
      if (fault.other_id >= 0) message += ", with agent " + std::to_string(fault.other_id);
      message += ", windows completed: " + std::to_string(fault.step / simulation_.shape().steps);
      throw std::runtime_error(message + ". " + text.remedy);
    }
  }

  Simulation simulation_;
  std::atomic<bool> running_{false};
};

/// Arrays that have one row per slot; all others are flat.
bool is_by_slot(const std::string& name) {
  static const std::set<std::string> names = {
      "alive",          "living",       "free",          "eaten",   "genome", "touch",    "params", "folded_bias",
      "paired_weights", "first_moment", "second_moment", "updates", "action", "log_prob", "value",  "reward"};
  return names.contains(name) || name.rfind("physics.bodies.", 0) == 0;
}

/// A read-only view of one array of a world's state, by its path; columns of structs are strided. Packed observations
/// are bytes, (slots, rollout_steps + 1, 192), as `learning.unpack` takes them.
nb::object view(nb::handle self, int index, const std::string& path) {
  World& world = nb::cast<PythonSimulation&>(self).world(index);
  const size_t slots = static_cast<size_t>(world.shape->slots);
  nb::object out;
  for_each_array(world.state, "", [&]<class T>(const std::string& name, Array<T>& array) {
    const size_t count = static_cast<size_t>(array.count);
    if constexpr (std::is_arithmetic_v<T>) {
      if (name != path) return;
      const bool table = is_by_slot(name) && count != slots;
      const size_t shape[2] = {table ? slots : count, table ? count / slots : 1};
      out = nb::cast(nb::ndarray<nb::numpy, const T>(array.data, table ? 2 : 1, shape, self));
    } else if constexpr (std::is_same_v<T, PackedObservation>) {
      if (name != path) return;
      const size_t shape[3] = {slots, count / slots, sizeof(T)};
      out =
          nb::cast(nb::ndarray<nb::numpy, const uint8_t>(reinterpret_cast<const uint8_t*>(array.data), 3, shape, self));
    } else if constexpr (requires { T::for_each_field([](auto...) {}); }) {
      T::for_each_field([&](const char* column, auto member) {
        using Field = std::remove_cvref_t<decltype(array.data->*member)>;
        if constexpr (std::is_arithmetic_v<Field>) {
          if (name + "." + column != path) return;
          const int64_t stride = sizeof(T) / sizeof(Field);
          out = nb::cast(nb::ndarray<nb::numpy, const Field>(&(array.data->*member), 1, &count, self, &stride));
        }
      });
    }
  });
  if (!out.is_valid()) throw nb::key_error(("no array named '" + path + "' in the state").c_str());
  return out;
}

/// Writes one number of the state, as a fault of the memory would: for tests of what finds it.
void poke(PythonSimulation& self, int index, const std::string& path, int64_t at, double value) {
  bool known = false;
  const auto write = [&]<class T>(T& number) {
    number = static_cast<T>(value);
    known = true;
  };
  for_each_array(self.world(index).state, "", [&]<class T>(const std::string& name, Array<T>& array) {
    if (at < 0 || at >= array.count) return;
    if constexpr (std::is_arithmetic_v<T>) {
      if (name == path) write(array[at]);
    } else if constexpr (requires { T::for_each_field([](auto...) {}); }) {
      T::for_each_field([&](const char* column, auto member) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(array[at].*member)>>) {
          if (name + "." + column == path) write(array[at].*member);
        }
      });
    }
  });
  if (!known) throw nb::key_error(("no number '" + path + "' of that index in the state").c_str());
}

nb::list view_names(PythonSimulation& self) {
  nb::list names;
  for_each_array(self.world(0).state, "", [&]<class T>(const std::string& name, Array<T>&) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, PackedObservation>) {
      names.append(name);
    } else if constexpr (requires { T::for_each_field([](auto...) {}); }) {
      T::for_each_field([&](const char* column, auto member) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(std::declval<T>().*member)>>)
          names.append(name + "." + column);
      });
    }
  });
  return names;
}

}  // namespace

void bind_simulation(nb::module_& module) {
  using S = PythonSimulation;
  module.def(
      "read_config", [](nb::dict config) { return unfill(to_config<WorldConfig>(config)); }, nb::arg("config"),
      nb::sig("def read_config(config: dict[str, typing.Any]) -> dict[str, typing.Any]"),
      "What the engine understood of a config.");
  module.def(
      "memory_needed",
      [](nb::dict config, int32_t walls, int64_t worlds, int threads) {
        return to_dict(
            Simulation::bytes_needed(to_config<WorldConfig>(config), walls, worlds, S::count_threads(threads)));
      },
      nb::arg("config"), nb::arg("walls"), nb::arg("worlds"), nb::arg("threads"),
      nb::sig(
          "def memory_needed(config: dict[str, typing.Any], walls: int, worlds: int, threads: int) -> dict[str, int]"),
      "Bytes that a simulation would reserve, by what they are for; 0 threads for all processors.");
  nb::class_<S>(module, "Simulation",
                "Many worlds under one config. Views are read-only and valid until the next `run`.")
      .def(nb::init<nb::dict, WallsIn, int32_t, const std::vector<uint64_t>&, int, const std::string&,
                    const std::vector<int32_t>&>(),
           nb::arg("config"), nb::arg("walls"), nb::arg("outer_walls"), nb::arg("seeds"), nb::arg("threads") = 1,
           nb::arg("kernel") = "", nb::arg("slot_order") = std::vector<int32_t>{})
      .def("run", &S::run, nb::arg("steps"), "Advances every world that is not over; releases the interpreter lock.")
      .def("take_rows", &S::take_rows, nb::arg("world"),
           nb::sig("def take_rows(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
           "Columns of the agents that died since the last call.")
      .def("living_rows", &S::living_rows, nb::arg("world"),
           nb::sig("def living_rows(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
           "Columns of the living, in the order of their ids.")
      .def("observations", &S::observations, nb::arg("world"),
           nb::sig("def observations(self, world: int) -> numpy.typing.NDArray[numpy.float32]"),
           "Full observations of the living: (living, size).")
      .def(
          "save",
          [](S& s, int world) {
            s.slotted(world);
            return to_arrays(s.get().save(world));
          },
          nb::arg("world"), nb::sig("def save(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
          "All that decides a world's future, as arrays: copies.")
      .def("restore", &S::restore, nb::arg("world"), nb::arg("arrays"),
           nb::sig("def restore(self, world: int, arrays: dict[str, numpy.typing.NDArray[typing.Any]]) -> None"),
           "Puts a saved world in place of one. ValueError: what is wrong; the world is then as it was.")
      .def("set_scene", &S::set_scene, nb::arg("world"), nb::arg("x"), nb::arg("y"), nb::arg("angle"),
           nb::arg("energy"), nb::arg("food_x"), nb::arg("food_y"), nb::arg("food_kind"),
           "Empties a world and puts these agents and foods into it.")
      .def(
          "view", [](nb::handle self, int world, const std::string& path) { return view(self, world, path); },
          nb::arg("world"), nb::arg("path"),
          nb::sig("def view(self, world: int, path: str) -> numpy.typing.NDArray[typing.Any]"),
          "One array of a world's state, by slot.")
      .def("view_names", &view_names, "Paths that `view` knows.")
      .def("poke", &poke, nb::arg("world"), nb::arg("path"), nb::arg("index"), nb::arg("value"),
           "For tests: writes one number of a world's state, as a fault of the memory would.")
      .def(
          "counters", [](S& s, int world) { return to_dict(s.world(world).counters()); }, nb::arg("world"))
      .def(
          "clock", [](S& s, int world) { return to_dict(s.world(world).clock()); }, nb::arg("world"))
      .def(
          "digest",
          [](S& s, int world) {
            s.slotted(world);
            return s.get().digest(world);
          },
          nb::arg("world"))
      .def(
          "seconds",
          [](S& s, int world) {
            s.world(world);
            nb::dict out;
            for (size_t p = 0; p < s.get().seconds(world).size(); ++p) out[PART_NAMES[p]] = s.get().seconds(world)[p];
            return out;
          },
          nb::arg("world"), "Seconds spent in each part by the world's first thread.")
      .def_prop_ro("world_count", [](S& s) { return s.get().world_count(); })
      .def_prop_ro("threads", [](S& s) { return s.get().pool().size(); })
      .def_prop_ro("kernel", [](S& s) { return s.get().kernel().name; })
      .def_prop_ro("bytes_per_world", [](S& s) { return s.get().bytes_per_world(); });
}

}  // namespace hedon
