/// Fills the engine's config structs from nested Python dicts and sequences, with the same code for all structs.
///
/// A missing name, an extra name or a value of the wrong type is an error that gives the path.
#pragma once

#include <nanobind/nanobind.h>

#include <set>
#include <string>
#include <type_traits>

#include "config/config.h"

namespace hedon {

template <class T>
struct IsFixedList : std::false_type {};
template <class T, int N>
struct IsFixedList<FixedList<T, N>> : std::true_type {};

template <class T>
void fill(nanobind::handle value, T& out, const std::string& path) {
  namespace nb = nanobind;
  if constexpr (std::is_enum_v<T>) {
    const auto name = nb::cast<std::string>(value);
    int at = 0;
    for (const char* text : EnumNames<T>::text) {
      if (name == text) {
        out = static_cast<T>(at);
        return;
      }
      ++at;
    }
    throw nb::value_error((path + ": unknown name '" + name + "'").c_str());
  } else if constexpr (std::is_arithmetic_v<T>) {
    if (!nb::try_cast<T>(value, out)) {
      // An int is allowed for a float; other conversions are not.
      if constexpr (std::is_floating_point_v<T>) {
        out = static_cast<T>(nb::cast<double>(nb::float_(value)));
      } else {
        throw nb::type_error((path + ": wrong type").c_str());
      }
    }
  } else if constexpr (Pair<T>) {
    for_each_part(out, [&](int i, auto& part) { fill(value[i], part, path + "[" + std::to_string(i) + "]"); });
  } else if constexpr (IsFixedList<T>::value) {
    const size_t count = nb::len(value);
    if (count > static_cast<size_t>(T::capacity)) throw nb::value_error((path + ": too many items").c_str());
    out.count = static_cast<int32_t>(count);
    for (size_t i = 0; i < count; ++i) fill(value[i], out.items[i], path + "[" + std::to_string(i) + "]");
  } else {
    const auto dict = nb::cast<nb::dict>(value);
    std::set<std::string> known;
    T::for_each_field([&](const char* name, auto member) {
      known.insert(name);
      const std::string inner = path.empty() ? name : path + "." + name;
      if (!dict.contains(name)) throw nb::key_error((inner + ": missing").c_str());
      fill(nb::object(dict[name]), out.*member, inner);
    });
    for (auto [key, unused] : dict) {
      const auto name = nb::cast<std::string>(key);
      if (!known.contains(name)) throw nb::key_error((path + "." + name + ": unknown").c_str());
    }
  }
}

/// The inverse of `fill`, for a test that every setting arrives.
template <class T>
nanobind::object unfill(const T& value) {
  namespace nb = nanobind;
  if constexpr (std::is_enum_v<T>) {
    return nb::str(EnumNames<T>::text[static_cast<int>(value)]);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return nb::cast(value);
  } else if constexpr (Pair<T>) {
    nb::list out;
    for_each_part(value, [&](int, const auto& part) { out.append(unfill(part)); });
    return out;
  } else if constexpr (IsFixedList<T>::value) {
    nb::list out;
    for (int32_t i = 0; i < value.count; ++i) out.append(unfill(value.items[i]));
    return out;
  } else {
    nb::dict out;
    T::for_each_field([&](const char* name, auto member) { out[name] = unfill(value.*member); });
    return out;
  }
}

/// A config struct from a nested dict.
template <class T>
T to_config(nanobind::dict dict) {
  T config{};
  fill(dict, config, "");
  return config;
}

}  // namespace hedon
