/// Only the physics: a scene that Python fills, steps and reads, for tests against closed forms and other engines.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <type_traits>
#include <vector>

#include "base/team.h"
#include "binding/config.h"
#include "binding/parts.h"
#include "binding/released.h"
#include "physics/step.h"

namespace nb = nanobind;

namespace hedon {
namespace {

/// One contact reported to the visitor.
struct ContactRow {
  int32_t kind, body, other;
  float direction_x, direction_y, angle;
};

/// Collects the contacts of each body separately, since islands run on different threads.
struct Recorder {
  std::vector<std::vector<ContactRow>> rows;
  bool record = true;

  void on_start(int32_t slot) { rows[static_cast<size_t>(slot)].clear(); }
  void on_contact(const Alone&, PairKind kind, int32_t body, int32_t other, Vec2 direction, float angle, uint8_t,
                  uint8_t& mark) {
    if (mark < 255) ++mark;
    if (record) {
      rows[static_cast<size_t>(body)].push_back(
          {static_cast<int32_t>(kind), body, other, direction.x, direction.y, angle});
    }
  }
};

/// Owns the memory of a scene.
class Scene {
 public:
  Scene(nb::dict config, float width, float height, float radius, float density, float circle_radius, int64_t bodies,
        int64_t circles, const std::vector<std::array<float, 4>>& walls, int64_t pair_limit, int32_t outer_walls,
        const std::vector<std::tuple<int32_t, float, float>>& classes)
      : config_(to_config<PhysicsConfig>(config)),
        shape_(make_disc(radius, density)),
        table_(uniform_bodies(shape_, circle_radius, bodies, circles)) {
    for (const auto& [first, own_radius, own_density] : classes) {
      const int32_t c = table_.classes++;
      if (c >= MAX_BODY_CLASSES || first < table_.first_slot[c - 1] || first > bodies)
        throw nb::value_error("classes: at most 3 more, with ascending first slots");
      table_.first_slot[c] = first;
      table_.first_slot[c + 1] = static_cast<int32_t>(bodies);
      table_.set_shape(c, make_disc(own_radius, own_density));
      for (int32_t other = 0; other <= c; ++other) table_.meets_bodies[other] = (2u << c) - 1u;
      table_.meets_circles[c] = 1;
    }
    capacity_ = physics_capacity(bodies, circles, static_cast<int64_t>(walls.size()), width, height, table_, config_);
    if (pair_limit > 0) capacity_.body_pairs = pair_limit;
    const auto allocate = [this](const char*, auto& array, int64_t count) {
      using Item = std::remove_reference_t<decltype(array[0])>;
      static_assert(std::is_trivially_copyable_v<Item> && alignof(Item) <= 16);
      memory_.push_back(std::make_unique<std::byte[]>(static_cast<size_t>(count) * sizeof(Item) + 1));
      array = {reinterpret_cast<Item*>(memory_.back().get()), count};
    };
    visit_state(state_, capacity_, allocate);
    visit_scratch(scratch_, capacity_, allocate);
    visit_arrays(force_, bodies, allocate);
    allocate("order", order_, bodies);
    init_physics(state_, capacity_);
    if (outer_walls > state_.walls.count) throw nb::value_error("outer_walls: more than there are walls");
    state_.outer_walls = outer_walls;
    for (size_t i = 0; i < walls.size(); ++i) {
      state_.walls[static_cast<int64_t>(i)] = {{walls[i][0], walls[i][1]}, {walls[i][2], walls[i][3]}};
    }
    recorder_.rows.resize(static_cast<size_t>(bodies));
  }

  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// All members of a team run all steps. Only one caller at a time may use a `Scene`.
  void step(int steps, int threads, bool record) {
    recorder_.record = record;
    TeamState shared;
    shared.size = threads;
    const auto member = [&](int rank) {
      Team team(shared, rank);
      for (int i = 0; i < steps; ++i) {
        if (!physics_step(team, config_, table_, state_, scratch_, order_, count_, force_, recorder_, fault_)) return;
      }
    };
    std::vector<std::thread> others;
    for (int rank = 1; rank < threads; ++rank) others.emplace_back(member, rank);
    member(0);
    for (std::thread& other : others) other.join();
    if (fault_.status == Status::ok) return;
    const std::string name = STATUS_TEXT[static_cast<int>(fault_.status)].name;
    fault_ = {};
    throw std::runtime_error(name);
  }

  void set_order(const std::vector<int32_t>& slots) {
    if (static_cast<int64_t>(slots.size()) > capacity_.bodies) throw nb::value_error("order: more than the capacity");
    count_ = static_cast<int32_t>(slots.size());
    for (size_t i = 0; i < slots.size(); ++i) {
      if (slots[i] < 0 || slots[i] >= capacity_.bodies) throw nb::index_error("order: no such slot");
      order_[static_cast<int64_t>(i)] = slots[i];
    }
    mark_stale(state_);
  }

  /// A writable view of one array of state or force.
  template <class T>
  auto view(const Array<T>& array) {
    return nb::ndarray<nb::numpy, T, nb::ndim<1>>(array.data, {static_cast<size_t>(array.count)}, nb::find(this));
  }

  nb::object array(const std::string& name) {
    nb::object found = nb::none();
    const auto match = [&](const char* field, auto member, auto& group) {
      if (name == field) found = nb::cast(view(group.*member));
    };
    BodyState::for_each_field([&](const char* field, auto member) { match(field, member, state_.bodies); });
    StaticCircles::for_each_field([&](const char* field, auto member) {
      match((std::string("circle_") + field).c_str(), member, state_.circles);
    });
    BodyForce::for_each_field(
        [&](const char* field, auto member) { match((std::string("force_") + field).c_str(), member, force_); });
    if (found.is_none()) throw nb::key_error(name.c_str());
    return found;
  }

  /// Listed pairs of a kind: (first slot, second slot or index, normal impulse, tangent impulse, mark) each, with
  /// impulses in [mass·u/s].
  nb::list pairs(const std::string& kind) const {
    const NeighborList& list = state_.neighbors;
    const PairList& from = kind == "body" ? list.bodies : (kind == "circle" ? list.circles : list.walls);
    nb::list out;
    for (int32_t i = 0; i < from.start[list.head[0].bodies]; ++i) {
      const int32_t second = kind == "body" ? list.slot[from.second[i]] : from.second[i];
      out.append(nb::make_tuple(list.slot[from.first[i]], second, shape_.mass * from.normal_impulse[i],
                                shape_.mass * from.tangent_impulse[i], from.mark[i]));
    }
    return out;
  }

  /// Contacts of the last step, by slot and time: (kind, body, other, direction x, direction y, angle) each.
  nb::list contacts() const {
    nb::list out;
    for (const auto& rows : recorder_.rows) {
      for (const ContactRow& row : rows) {
        out.append(nb::make_tuple(row.kind, row.body, row.other, row.direction_x, row.direction_y, row.angle));
      }
    }
    return out;
  }

  /// Slots of bodies or circles whose cells are within reach of a point.
  std::vector<int32_t> near(const std::string& kind, float x, float y, float reach) const {
    std::vector<int32_t> out;
    const auto add = [&](int32_t item) { out.push_back(item); };
    if (kind == "body")
      for_each_body_near(state_, x, y, reach, add);
    else
      for_each_circle_near(state_, x, y, reach, add);
    return out;
  }

  /// Puts a circle into its slot and into the grid, as a world does between steps.
  void add_circle(int32_t slot, float x, float y) {
    state_.circles.x[slot] = x;
    state_.circles.y[slot] = y;
    state_.circles.present[slot] = 1;
    insert(state_.circle_grid, slot, x, y);
    mark_stale(state_);
  }

  void remove_circle(int32_t slot) {
    state_.circles.present[slot] = 0;
    remove(state_.circle_grid, slot);
    mark_stale(state_);
  }

  nb::dict counters() const {
    const NeighborHead& head = state_.neighbors.head[0];
    nb::dict out;
    out["builds"] = head.builds;
    out["repeats"] = head.repeats;
    out["skin"] = head.skin;
    out["batches"] = head.batches;
    out["mass"] = shape_.mass;
    out["inertia"] = shape_.inertia;
    return out;
  }

  void set_stale() { mark_stale(state_); }

 private:
  PhysicsConfig config_;
  BodyShape shape_;
  BodyTable table_;
  PhysicsCapacity capacity_{};
  PhysicsState state_{};
  PhysicsScratch scratch_{};
  BodyForce force_{};
  Array<int32_t> order_{};
  int32_t count_ = 0;
  Fault fault_{};
  Recorder recorder_;
  std::vector<std::unique_ptr<std::byte[]>> memory_;
};

}  // namespace

void bind_physics(nb::module_& module) {
  nb::module_ physics = module.def_submodule("physics", "Rigid bodies without the rest of the model.");
  nb::class_<Scene>(physics, "Scene", "Discs, static circles and walls, with their memory.")
      .def(nb::init<nb::dict, float, float, float, float, float, int64_t, int64_t,
                    const std::vector<std::array<float, 4>>&, int64_t, int32_t,
                    const std::vector<std::tuple<int32_t, float, float>>&>(),
           nb::arg("config"), nb::arg("width"), nb::arg("height"), nb::arg("radius"), nb::arg("density"),
           nb::arg("circle_radius"), nb::arg("bodies"), nb::arg("circles"), nb::arg("walls"), nb::arg("pair_limit") = 0,
           nb::arg("outer_walls") = 0, nb::arg("classes") = std::vector<std::tuple<int32_t, float, float>>{})
      .def("step", &Scene::step, nb::arg("steps") = 1, nb::arg("threads") = 1, nb::arg("record") = true,
           nb::call_guard<Released>(), "Steps; raises RuntimeError with the name of a fault.")
      .def("set_order", &Scene::set_order, nb::arg("slots"), "Slots of the bodies that live, in canonical order.")
      .def("array", &Scene::array, nb::arg("name"),
           nb::sig("def array(self, name: str) -> numpy.typing.NDArray[typing.Any]"),
           "A writable view of one array by slot.")
      .def("pairs", &Scene::pairs, nb::arg("kind"),
           nb::sig("def pairs(self, kind: str) -> list[tuple[int, int, float, float, int]]"),
           "Listed pairs with impulses and marks.")
      .def("contacts", &Scene::contacts, "Contacts that were reported to the visitor in the last step.")
      .def("near", &Scene::near, nb::arg("kind"), nb::arg("x"), nb::arg("y"), nb::arg("reach"))
      .def("add_circle", &Scene::add_circle, nb::arg("slot"), nb::arg("x"), nb::arg("y"))
      .def("remove_circle", &Scene::remove_circle, nb::arg("slot"))
      .def("set_stale", &Scene::set_stale, "Call after a change of positions, circles or the order.")
      .def("counters", &Scene::counters);
}

}  // namespace hedon
