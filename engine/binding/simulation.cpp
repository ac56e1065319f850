/// `_engine.Simulation`: many worlds, advanced with the interpreter lock released and read as NumPy arrays.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/float_mode.h"
#include "base/platform.h"
#include "binding/checkpoint.h"
#include "binding/config.h"
#include "binding/device.h"
#include "binding/drive.h"
#include "binding/parts.h"
#include "binding/python_simulation.h"
#include "binding/state_view.h"
#include "world/expression.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using FloatsIn = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IntsIn = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// A copy with its own memory, as a NumPy array.
template <class T>
nb::object copy_array(std::vector<T> values, std::vector<size_t> shape) {
  auto* held = new std::vector<T>(std::move(values));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(held->data(), shape.size(), shape.data(), owner));
}

/// Rows of lives as a dict of columns.
nb::dict columns(const Life* life, const int32_t* eaten, const float* genome, const double* store,
                 const std::vector<int64_t>& rows, const WorldShape& shape) {
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
  out["eaten"] = table(eaten, shape.meals());
  out["genome"] = table(genome, shape.genes);
  out["store"] = table(store, shape.stores - 1);
  return out;
}

template <class Struct>
nb::dict to_dict(const Struct& values) {
  nb::dict out;
  Struct::for_each_field([&](const char* name, auto member) { out[name] = values.*member; });
  return out;
}

/// The waiting deaths, oldest first.
std::vector<int64_t> waiting_rows(const World& world) {
  const WorldHead& head = world.head();
  const int64_t waiting = std::clamp(head.death_log_count, 0, world.shape->death_log_rows);
  std::vector<int64_t> rows;
  for (int64_t i = 0; i < waiting; ++i)
    rows.push_back(head.death_log_lost == 0 ? i : (head.death_log_lost + i) % waiting);
  return rows;
}

nb::dict take_rows(PythonSimulation& self, int index) {
  World& from = self.world(index);
  const WorldState& state = from.state;
  const std::vector<int64_t> rows = waiting_rows(from);
  nb::dict out = columns(state.death_log.data, state.death_log_eaten.data, state.death_log_genome.data,
                         state.death_log_store.data, rows, *from.shape);
  const auto column = [&](const Array<int32_t>& of) {
    std::vector<int32_t> values;
    for (const int64_t row : rows) values.push_back(of[row]);
    return copy_array(std::move(values), {rows.size()});
  };
  out["species"] = column(state.death_log_species);
  out["cause"] = column(state.death_log_cause);
  if (from.shape->mating) out["mate_id"] = column(state.death_log_mate);
  from.head().death_log_count = 0;
  from.head().death_log_lost = 0;
  return out;
}

nb::dict living_rows(PythonSimulation& self, int index) {
  const World& from = self.slotted(index);
  std::vector<int64_t> rows;
  for (int32_t i = 0; i < from.head().living_count; ++i) rows.push_back(from.state.living[i]);
  nb::dict out = columns(from.state.life.data, from.state.eaten.data, from.state.genome.data, from.state.store.data,
                         rows, *from.shape);
  std::vector<int32_t> species;
  for (const int64_t slot : rows) species.push_back(from.shape->species_of(static_cast<int32_t>(slot)));
  out["species"] = copy_array(std::move(species), {rows.size()});
  out["cause"] = copy_array(std::vector<int32_t>(rows.size(), -1), {rows.size()});
  if (!from.shape->mating) return out;
  std::vector<int32_t> mates;
  for (const int64_t slot : rows) mates.push_back(from.state.mate_id[slot]);
  out["mate_id"] = copy_array(std::move(mates), {rows.size()});
  return out;
}

/// Full observations of the living agents of one species, in their order, from the current state.
nb::object observations(PythonSimulation& self, int index, int32_t species) {
  World& from = self.slotted(index);
  if (species < 0 || species >= from.shape->species) throw nb::index_error("no species has this index");
  const FloatMode mode(self.get().flush());
  const ObservationShape& shape = from.shape->of[species].network.observation;
  const size_t size = static_cast<size_t>(shape.size());
  std::vector<float> full;
  gather_scene(Alone{}, from);
  size_t count = 0;
  for (int32_t i = 0; i < from.head().living_count; ++i) {
    const int32_t slot = from.state.living[i];
    if (from.shape->species_of(slot) != species) continue;
    note_start(from, slot);
    full.resize(++count * size);
    ObservationLine lines[WIDE_LINES];
    PackedObservation& seen = *reinterpret_cast<PackedObservation*>(lines);
    observe(from, slot, 0, seen);
    unpack(shape, seen, &full[(count - 1) * size]);
  }
  return copy_array(std::move(full), {count, size});
}

void set_scene(PythonSimulation& self, int index, FloatsIn x, FloatsIn y, FloatsIn angle, FloatsIn energy,
               IntsIn species, FloatsIn food_x, FloatsIn food_y, IntsIn food_kind) {
  self.world(index);
  const size_t agents = x.shape(0), foods = food_x.shape(0);
  if (y.shape(0) != agents || angle.shape(0) != agents || energy.shape(0) != agents || species.shape(0) != agents ||
      food_y.shape(0) != foods || food_kind.shape(0) != foods) {
    throw nb::value_error("all arrays of agents must have the same length, and all arrays of foods too");
  }
  const auto view = []<class T>(const T& array) {
    return Array<const typename T::Scalar>{array.data(), static_cast<int64_t>(array.shape(0))};
  };
  if (!self.get().set_scene(index, {view(x), view(y), view(angle), view(energy), view(species), view(food_x),
                                    view(food_y), view(food_kind)})) {
    throw nb::value_error(
        "there are more agents of a species than slots, more foods of a kind than its capacity, or an unknown species "
        "or "
        "kind");
  }
}

/// Replaces the genomes of a world's living agents, in their order, and applies the genes that set parts of networks.
void set_genomes(PythonSimulation& self, int index,
                 nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu> genomes) {
  self.slotted(index);
  World& from = self.get().world(index);  // genes can set parts of networks
  const size_t width = static_cast<size_t>(from.shape->genes);
  if (genomes.shape(0) != static_cast<size_t>(from.head().living_count) || genomes.shape(1) != width)
    throw nb::value_error("there must be one genome for each living agent, with all genes");
  const auto each = [&](auto&& visit) {
    for (size_t i = 0; i < genomes.shape(0); ++i) {
      const int32_t slot = from.state.living[static_cast<int64_t>(i)];
      const SpeciesLayout& layout = from.species(slot).layout;
      for (int32_t g = 0; g < layout.genes.count; ++g)
        visit(genomes.data()[i * width + static_cast<size_t>(g)], layout.genes[g].limit(), from.genome(slot)[g]);
    }
  };
  each([](float value, float limit, float&) {
    if (!(std::fabs(value) <= limit)) throw nb::value_error("genes must be within ± weight_limit");
  });
  each([](float value, float, float& gene) { gene = value; });
  for (int32_t i = 0; i < from.head().living_count; ++i) express_genes(from, from.state.living[i]);
  if (from.shape->bodies.own != 0) place_founders_again(from);
}

/// Replaces the networks of the living agents of a species in a world, in their order.
void set_networks(PythonSimulation& self, int index, int species,
                  nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu> networks) {
  self.slotted(index);
  World& from = self.get().world(index);
  if (species < 0 || species >= from.shape->species || !from.shape->of[species].has_network)
    throw nb::value_error("there is no such species, or it has no networks");
  std::vector<int32_t> slots;
  for (int32_t i = 0; i < from.head().living_count; ++i) {
    if (from.shape->species_of(from.state.living[i]) == species) slots.push_back(from.state.living[i]);
  }
  const NetworkShape& network = from.shape->of[species].network;
  const size_t size = static_cast<size_t>(network.size());
  if (networks.shape(0) != slots.size() || networks.shape(1) != size)
    throw nb::value_error("there must be one network for each living agent of the species, with all parameters");
  for (size_t p = 0; p < slots.size() * size; ++p) {
    if (!std::isfinite(networks.data()[p])) throw nb::value_error("parameters must be finite");
  }
  for (size_t i = 0; i < slots.size(); ++i) {
    std::copy_n(networks.data() + i * size, size, from.params(slots[i]));
    from.kernel->network.pack_weights(network, from.network(slots[i]));
    keep_initial(from, slots[i]);
  }
}

/// The address of a function `Rule`, which the caller must keep alive as long as the simulation.
void set_rule(PythonSimulation& self, int32_t species, const std::string& use, uint64_t address,
              const std::string& name) {
  if (species < 0 || species >= self.get().shape().species) throw nb::index_error("no species has this index");
  for (int32_t u = 0; u < RULE_USES; ++u) {
    if (use != EnumNames<RuleUse>::text[u]) continue;
    self.set_rule({species, static_cast<RuleUse>(u), name}, reinterpret_cast<Rule>(static_cast<uintptr_t>(address)));
    return;
  }
  throw nb::value_error("a rule is for reward, hazard or birth");
}

/// `FloatMode` as a context manager.
class PythonFloatMode {
 public:
  void enter() { mode_.emplace(); }
  void exit(nb::args) { mode_.reset(); }

 private:
  std::optional<FloatMode> mode_;
};

}  // namespace

void bind_simulation(nb::module_& module) {
  using S = PythonSimulation;
  module.def(
      "read_config", [](nb::dict config) { return from_config(to_config<Config>(config)); }, nb::arg("config"),
      nb::sig("def read_config(config: dict[str, typing.Any]) -> dict[str, typing.Any]"),
      "A config as the engine has read it.");
  module.def(
      "memory_needed",
      [](nb::dict config, int32_t walls, int64_t worlds, int threads) {
        return to_dict(Simulation::bytes_needed(need_config(config), walls, worlds, S::count_threads(threads)));
      },
      nb::arg("config"), nb::arg("walls"), nb::arg("worlds"), nb::arg("threads"),
      nb::sig(
          "def memory_needed(config: dict[str, typing.Any], walls: int, worlds: int, threads: int) -> dict[str, int]"),
      "Bytes that a simulation would reserve, by purpose; 0 threads for all processors.");
  module.def("physical_memory", &physical_memory, nb::sig("def physical_memory() -> int"),
             "Bytes of memory of this machine.");
  module.def(
      "batch_address", [] { return reinterpret_cast<uintptr_t>(&step_batch); },
      "Address of a function that steps driven worlds without Python: `engine/binding/batch.h`.");
  module.def(
      "open_device", [](const std::string& file) { open_device(file); }, nb::arg("file"),
      "Loads the library of a device and finds the device. EngineError: why it cannot be used.");
  nb::class_<PythonFloatMode>(module, "FloatMode",
                              "Context manager: this thread computes with floats as the engine does.")
      .def(nb::init<>())
      .def("__enter__", &PythonFloatMode::enter)
      .def("__exit__", &PythonFloatMode::exit, nb::sig("def __exit__(self, *error: object) -> None"));
  nb::class_<S>(
      module, "Simulation",
      "Many worlds under one config. Views are read-only and valid until the next `run`. EngineError: it runs "
      "in another thread, or this process was forked from the one that made it.")
      .def(nb::init<nb::dict, WallsIn, int64_t, const std::vector<uint64_t>&, int, const std::string&,
                    const std::vector<int32_t>&, bool, const std::string&, const std::string&>(),
           nb::arg("config"), nb::arg("walls"), nb::arg("outer_walls"), nb::arg("seeds"), nb::arg("threads") = 1,
           nb::arg("kernel") = "", nb::arg("slot_order") = std::vector<int32_t>{}, nb::arg("flush_denormals") = true,
           nb::arg("device") = "", nb::arg("scratch") = "")
      .def("run", &S::run, nb::arg("steps"),
           "Advances every world that is not over; releases the interpreter lock. Ctrl-C raises KeyboardInterrupt.")
      .def("take_rows", &take_rows, nb::arg("world"),
           nb::sig("def take_rows(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
           "Columns of the agents that died since the last call, the oldest first: the newest of them, as many as "
           "`death_log` has rows. "
           "`head` says before how many older ones are lost (`death_log_lost`).")
      .def("living_rows", &living_rows, nb::arg("world"),
           nb::sig("def living_rows(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
           "Columns of the living, in the order of their ids.")
      .def("observations", &observations, nb::arg("world"), nb::arg("species") = 0,
           nb::sig("def observations(self, world: int, species: int = 0) -> numpy.typing.NDArray[numpy.float32]"),
           "Full observations of the living of a species: (living, size).")
      .def(
          "save",
          [](S& s, int world) {
            s.slotted(world);
            s.need_whole(world);
            return to_arrays(s.get().save(world));
          },
          nb::arg("world"), nb::sig("def save(self, world: int) -> dict[str, numpy.typing.NDArray[typing.Any]]"),
          "Copies of everything that determines a world's future, as arrays.")
      .def("save_to", &save_to, nb::arg("world"), nb::arg("begin"), nb::arg("piece"),
           nb::sig("def save_to(self, world: int, begin: typing.Callable[[str, str, list[int]], object], "
                   "piece: typing.Callable[[bytes], object]) -> None"),
           "The same in pieces, without memory for copies: begin(name, type, shape) for each array in turn, then "
           "piece(bytes) until all its bytes are passed.")
      .def("restore", &restore_from, nb::arg("world"), nb::arg("arrays"),
           nb::sig("def restore(self, world: int, arrays: dict[str, numpy.typing.NDArray[typing.Any]]) -> None"),
           "Replaces a world by a saved one. ValueError: what is wrong; the world is then unchanged.")
      .def("pack", &pack, nb::arg("head"),
           "All worlds with their seeds, and a text of the caller's, as one byte string.")
      .def_static("packed_head", &packed_head, nb::arg("packed"),
                  "The caller's text in the result of `pack`. ValueError: it is damaged, or not a result of `pack`.")
      .def("unpack", &unpack_into, nb::arg("packed"),
           "Replaces all worlds, and their seeds, by the ones in the result of `pack`, in which `packed_head` has "
           "found no damage. ValueError: what is wrong; all worlds are then unchanged.")
      .def("reset", &S::reset, nb::arg("world"), nb::arg("seed"), "Begins a world again with this seed.")
      .def(
          "seed", [](S& s, int world) { return s.world(world).seed; }, nb::arg("world"))
      .def("set_rule", &set_rule, nb::arg("species"), nb::arg("use"), nb::arg("address"), nb::arg("name"),
           "Gives a species the function for its reward, hazard or birth, by its address: void(int64 count, double "
           "*records, double *answers). Messages about faults of the rule contain its name.")
      .def("wrong_action", &wrong_action, nb::arg("species"), nb::arg("actions"), nb::arg("form") = "logit",
           nb::sig("def wrong_action(self, species: int, actions: numpy.typing.NDArray[numpy.float32], form: str = "
                   "'logit') -> int"),
           "The index of an invalid action of a living agent, as from `set_actions`, or -1; sets no action.")
      .def("set_actions", &set_actions, nb::arg("species"), nb::arg("actions"), nb::arg("form") = "logit",
           nb::sig("def set_actions(self, species: int, actions: numpy.typing.NDArray[numpy.float32], form: str = "
                   "'logit') -> int"),
           "Sets the actions of the agents of an external species from now on: (worlds, slots, 2), as `unit`, `force` "
           "or `logit`. Returns -1, or the index of a living agent's action out of bounds; then no action is set.")
      .def(
          "read_observations", &read_observations, nb::arg("species"), nb::arg("observation"), nb::arg("reward"),
          nb::arg("agent_id"),
          nb::sig("def read_observations(self, species: int, observation: numpy.typing.NDArray[numpy.float32], reward: "
                  "numpy.typing.NDArray[numpy.float32], agent_id: numpy.typing.NDArray[numpy.int32]) -> int"),
          "Writes the observations of an external species' agents, their rewards in the last step, and their ids into "
          "arrays of (worlds, slots, …). Returns in how many slots the agent differs from `agent_id`.")
      .def("read_rewards", &read_rewards, nb::arg("species"), nb::arg("reward"), nb::arg("agent_id"),
           nb::sig("def read_rewards(self, species: int, reward: numpy.typing.NDArray[numpy.float32], agent_id: "
                   "numpy.typing.NDArray[numpy.int32]) -> None"),
           "The same without observations.")
      .def("meals", &meals_of, nb::arg("species"),
           nb::sig("def meals(self, species: int) -> numpy.typing.NDArray[numpy.int64]"),
           "Numbers of meals of a species since the worlds began, foods by kind and then agents by species: (worlds, "
           "meals).")
      .def("set_scene", &set_scene, nb::arg("world"), nb::arg("x"), nb::arg("y"), nb::arg("angle"), nb::arg("energy"),
           nb::arg("species"), nb::arg("food_x"), nb::arg("food_y"), nb::arg("food_kind"),
           "Empties a world and puts these agents and foods into it.")
      .def("set_genomes", &set_genomes, nb::arg("world"), nb::arg("genomes"),
           nb::sig("def set_genomes(self, world: int, genomes: numpy.typing.NDArray[numpy.float32]) -> None"),
           "Replaces the genomes of the living: (living, genes). ValueError: wrong shape, or a gene out of bounds.")
      .def("set_networks", &set_networks, nb::arg("world"), nb::arg("species"), nb::arg("networks"),
           nb::sig("def set_networks(self, world: int, species: int, networks: "
                   "numpy.typing.NDArray[numpy.float32]) -> None"),
           "Replaces the networks of the living of a species: (living, parameters). ValueError: wrong shape, or a "
           "parameter that is not finite.")
      .def(
          "view", [](nb::handle self, int world, const std::string& path) { return view_state(self, world, path); },
          nb::arg("world"), nb::arg("path"),
          nb::sig("def view(self, world: int, path: str) -> numpy.typing.NDArray[typing.Any]"),
          "One array of a world's state, by slot.")
      .def("view_names", &state_names, "Paths that `view` knows.")
      .def(
          "counters",
          [](S& s, int world, int species) {
            const Array<Counters>& counters = s.world(world).state.counters;
            if (species < 0 || species >= counters.count) throw nb::index_error("no species has this index");
            return to_dict(counters[species]);
          },
          nb::arg("world"), nb::arg("species") = 0, "Counts and the energy ledger of one species.")
      .def(
          "head", [](S& s, int world) { return to_dict(s.world(world).head()); }, nb::arg("world"))
      .def(
          "digest",
          [](S& s, int world) {
            s.slotted(world);
            s.need_whole(world);
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
      .def_prop_ro(
          "device_seconds",
          [](S& s) {
            const DeviceSeconds seconds = s.get().device_seconds();
            nb::dict out;
            for (size_t p = 0; p < DEVICE_PARTS; ++p) out[DEVICE_PART_NAMES[p]] = seconds.kernel[p];
            out["copying"] = seconds.copying;
            return out;
          },
          "Seconds that devices spent in each kernel, and copying; zeros without devices.")
      .def_prop_ro(
          "id", [](S& s) { return s.id(); }, "A number that no other simulation of this process has, for `step_batch`.")
      .def_prop_rw(
          "turn", [](S& s) { return s.turn(); }, [](S& s, uint32_t turn) { s.set_turn(turn); },
          "The turn of the state from which `step_batch` continues.")
      .def_prop_ro("device_count", [](S& s) { return s.get().device_count(); })
      .def_prop_ro("world_count", [](S& s) { return s.get().world_count(); })
      .def_prop_ro("threads", [](S& s) { return s.get().pool().size(); })
      .def_prop_ro("backend", [](S& s) { return s.get().kernel_name(); })
      .def_prop_ro("bytes_per_world", [](S& s) { return s.get().bytes_per_world(); });
}

}  // namespace hedon
