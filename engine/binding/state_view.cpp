#include "binding/state_view.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <set>

namespace nb = nanobind;

namespace hedon {
namespace {

/// Arrays that have one row per slot. All others are flat.
bool is_by_slot(const std::string& name) {
  static const std::set<std::string> names = {
      "alive",          "living",       "free",          "eaten",   "genome", "touch",    "params", "folded_bias",
      "packed_weights", "first_moment", "second_moment", "updates", "action", "log_prob", "value",  "reward"};
  return names.contains(name) || name.rfind("physics.bodies.", 0) == 0;
}

}  // namespace

nb::object view_state(nb::handle self, int index, const std::string& path) {
  World& world = nb::cast<PythonSimulation&>(self).world(index);
  const size_t capacity = static_cast<size_t>(world.shape->capacity);
  nb::object out;
  for_each_array(world.state, "", [&]<class T>(const std::string& name, Array<T>& array) {
    const size_t count = static_cast<size_t>(array.count);
    if constexpr (std::is_arithmetic_v<T>) {
      if (name != path) return;
      const bool table = is_by_slot(name) && count != capacity;
      const size_t shape[2] = {table ? capacity : count, table ? count / capacity : 1};
      out = nb::cast(nb::ndarray<nb::numpy, const T>(array.data, table ? 2 : 1, shape, self));
    } else if constexpr (std::is_same_v<T, PackedObservation>) {
      if (name != path) return;
      const size_t shape[3] = {capacity, count / capacity, sizeof(T)};
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

nb::list state_names(PythonSimulation& self) {
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

}  // namespace hedon
