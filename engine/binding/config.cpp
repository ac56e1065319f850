#include "binding/config.h"

#include <nanobind/stl/string.h>

#include <set>
#include <string>
#include <type_traits>

namespace nb = nanobind;

namespace hedon {
namespace {

/// The fields of a dict for one struct. Its functions are the same for all structs, so they are compiled once.
class Fields {
 public:
  Fields(nb::handle value, const std::string& path) : dict_(nb::cast<nb::dict>(value)), path_(path) {}

  std::string inner(const char* name) const { return path_.empty() ? name : path_ + "." + name; }

  nb::object take(const char* name) {
    known_.insert(name);
    if (!dict_.contains(name)) throw nb::key_error((inner(name) + ": missing").c_str());
    return dict_[name];
  }

  /// Fails if there is a field that was not taken.
  void finish() const {
    for (auto [key, unused] : dict_) {
      const auto name = nb::cast<std::string>(key);
      if (!known_.contains(name)) throw nb::key_error((inner(name.c_str()) + ": unknown").c_str());
    }
  }

 private:
  nb::dict dict_;
  const std::string& path_;
  std::set<std::string> known_;
};

std::string at(const std::string& path, size_t item) { return path + "[" + std::to_string(item) + "]"; }

template <size_t N>
int find_name(const char* const (&names)[N], nb::handle value, const std::string& path) {
  const auto name = nb::cast<std::string>(value);
  for (size_t i = 0; i < N; ++i) {
    if (name == names[i]) return static_cast<int>(i);
  }
  throw nb::value_error((path + ": unknown name '" + name + "'").c_str());
}

/// Fills `out` from nested dicts and sequences.
template <class T>
void fill(nb::handle value, T& out, const std::string& path) {
  if constexpr (std::is_enum_v<T>) {
    out = static_cast<T>(find_name(EnumNames<T>::text, value, path));
  } else if constexpr (std::is_arithmetic_v<T>) {
    if (nb::try_cast<T>(value, out)) return;
    // An int is allowed for a float; other conversions are not.
    if constexpr (std::is_floating_point_v<T>)
      out = static_cast<T>(nb::cast<double>(nb::float_(value)));
    else
      throw nb::type_error((path + ": wrong type").c_str());
  } else if constexpr (Pair<T>) {
    for_each_part(out, [&](int i, auto& part) { fill(value[i], part, at(path, static_cast<size_t>(i))); });
  } else if constexpr (IS_FIXED_LIST<T>) {
    const size_t count = nb::len(value);
    if (count > static_cast<size_t>(T::capacity)) throw nb::value_error((path + ": too many items").c_str());
    out.count = static_cast<int32_t>(count);
    for (size_t i = 0; i < count; ++i) fill(value[i], out.items[i], at(path, i));
  } else {
    Fields fields(value, path);
    T::for_each_field([&](const char* name, auto member) { fill(fields.take(name), out.*member, fields.inner(name)); });
    fields.finish();
  }
}

/// The inverse of `fill`.
template <class T>
nb::object unfill(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return nb::str(EnumNames<T>::text[static_cast<int>(value)]);
  } else if constexpr (std::is_arithmetic_v<T>) {
    return nb::cast(value);
  } else if constexpr (Pair<T>) {
    nb::list out;
    for_each_part(value, [&](int, const auto& part) { out.append(unfill(part)); });
    return out;
  } else if constexpr (IS_FIXED_LIST<T>) {
    nb::list out;
    for (int32_t i = 0; i < value.count; ++i) out.append(unfill(value.items[i]));
    return out;
  } else {
    nb::dict out;
    T::for_each_field([&](const char* name, auto member) { out[name] = unfill(value.*member); });
    return out;
  }
}

}  // namespace

template <class T>
T to_config(nb::dict dict) {
  T config{};
  fill(dict, config, "");
  return config;
}

template Config to_config(nb::dict dict);
template LearningConfig to_config(nb::dict dict);
template PhysicsConfig to_config(nb::dict dict);

nb::object from_config(const Config& config) { return unfill(config); }

}  // namespace hedon
