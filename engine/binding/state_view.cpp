#include "binding/state_view.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <string>

namespace nb = nanobind;

namespace hedon {
namespace {

/// The number of rows of an array that has several values in each; 0 for all other arrays.
int64_t table_rows(const World& world, const std::string& wanted) {
  int64_t rows = 0;
  WorldState::for_each_shape([&](const char* name, auto, ArrayShape size) {
    if (name == wanted && size.width != Extent::one) rows = extent(*world.shape, size.rows, 1);
  });
  return rows;
}

/// Whether an array is part of the networks and rollouts.
bool is_large(const std::string& wanted) {
  bool large = false;
  WorldState::for_each_shape(
      [&](const char* name, auto, ArrayShape size) { large |= name == wanted && Device::is_large(size); });
  return large;
}

}  // namespace

nb::object view_state(nb::handle self, int index, const std::string& path) {
  PythonSimulation& simulation = nb::cast<PythonSimulation&>(self);
  World& world = simulation.world(index);
  if (is_large(path)) simulation.need_whole(index);
  const size_t capacity = static_cast<size_t>(world.shape->capacity);
  nb::object out;
  for_each_array(world.state, "", [&]<class T>(const std::string& name, Array<T>& array) {
    const size_t count = static_cast<size_t>(array.count);
    if constexpr (std::is_arithmetic_v<T>) {
      if (name != path) return;
      const size_t rows = static_cast<size_t>(table_rows(world, name));
      const size_t shape[2] = {rows > 0 ? rows : count, rows > 0 ? count / rows : 1};
      out = nb::cast(nb::ndarray<nb::numpy, const T>(array.data, rows > 0 ? 2 : 1, shape, self));
    } else if constexpr (std::is_same_v<T, ObservationLine>) {
      if (name != path) return;
      const size_t bytes = static_cast<size_t>(world.shape->lines) * sizeof(T);
      const size_t shape[3] = {capacity, count * sizeof(T) / (capacity * bytes), bytes};
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
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, ObservationLine>) {
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
