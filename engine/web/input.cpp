#include "web/input.h"

#include <cstdlib>
#include <map>
#include <type_traits>

#include "config/config.h"

namespace hedon {
namespace {

/// The settings that have not been read yet, and the first error.
class Lines {
 public:
  void add(const std::string& path, const std::string& value) {
    if (!values_.emplace(path, value).second) complain(path, "is there twice");
  }

  bool has(const std::string& path) const { return values_.count(path) > 0; }

  std::string take(const std::string& path) {
    const auto found = values_.find(path);
    if (found == values_.end()) {
      complain(path, "is missing");
      return "";
    }
    const std::string value = found->second;
    values_.erase(found);
    return value;
  }

  /// Whether the path of any remaining setting begins like this.
  bool any(const std::string& prefix) const {
    const auto next = values_.lower_bound(prefix);
    return next != values_.end() && next->first.compare(0, prefix.size(), prefix) == 0;
  }

  void complain(const std::string& path, const std::string& what) {
    if (complaint_.empty()) complaint_ = path + ": " + what;
  }

  std::string finish() {
    if (!values_.empty()) complain(values_.begin()->first, "is unknown");
    return complaint_;
  }

 private:
  std::map<std::string, std::string> values_;
  std::string complaint_;
};

template <class T>
T to_number(Lines& settings, const std::string& path, const std::string& text) {
  char* end = nullptr;
  T value;
  if constexpr (std::is_same_v<T, bool>) {
    if (text == "true" || text == "false") return text == "true";
    end = const_cast<char*>(text.c_str());
    value = false;
  } else if constexpr (std::is_floating_point_v<T>) {
    value = static_cast<T>(strtod(text.c_str(), &end));
  } else if constexpr (std::is_unsigned_v<T>) {
    value = static_cast<T>(strtoull(text.c_str(), &end, 10));
  } else {
    value = static_cast<T>(strtoll(text.c_str(), &end, 10));
  }
  if (text.empty() || *end != '\0') settings.complain(path, "'" + text + "' is not a value for it");
  return value;
}

template <class T>
void fill(Lines& settings, const std::string& path, T& out) {
  if constexpr (std::is_enum_v<T>) {
    const std::string name = settings.take(path);
    int at = 0;
    for (const char* known : EnumNames<T>::text) {
      if (name == known) {
        out = static_cast<T>(at);
        return;
      }
      ++at;
    }
    settings.complain(path, "unknown name '" + name + "'");
  } else if constexpr (std::is_arithmetic_v<T>) {
    out = to_number<T>(settings, path, settings.take(path));
  } else if constexpr (Pair<T>) {
    for_each_part(out, [&](int i, auto& part) { fill(settings, path + "[" + std::to_string(i) + "]", part); });
  } else if constexpr (IS_FIXED_LIST<T>) {
    const auto place = [&](int32_t i) { return path + "[" + std::to_string(i) + "]"; };
    const auto present = [&](int32_t i) {
      return settings.has(place(i)) || settings.any(place(i) + ".") || settings.any(place(i) + "[");
    };
    for (out.count = 0; out.count < T::capacity && present(out.count); ++out.count)
      fill(settings, place(out.count), out.items[out.count]);
  } else {
    T::for_each_field(
        [&](const char* name, auto member) { fill(settings, path.empty() ? name : path + "." + name, out.*member); });
  }
}

Segment to_wall(Lines& settings, const std::string& text) {
  float value[4] = {};
  const char* at = text.c_str();
  for (int i = 0; i < 4; ++i) {
    char* end = nullptr;
    value[i] = static_cast<float>(strtod(at, &end));
    if (end == at || *end != (i < 3 ? ',' : '\0')) {
      settings.complain("wall", "'" + text + "' is not four numbers");
      return {};
    }
    at = end + 1;
  }
  return {{value[0], value[1]}, {value[2], value[3]}};
}

}  // namespace

std::string read_input(const std::string& text, WorldInput& out) {
  Lines settings;
  out = WorldInput{};
  for (size_t at = 0; at < text.size();) {
    size_t end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.empty()) continue;
    const size_t equals = line.find('=');
    if (equals == std::string::npos) {
      settings.complain(line, "has no value");
      continue;
    }
    const std::string path = line.substr(0, equals), value = line.substr(equals + 1);
    if (path == "wall") {
      out.walls.push_back(to_wall(settings, value));
    } else {
      settings.add(path, value);
    }
  }
  fill(settings, "seed", out.seed);
  fill(settings, "outer_walls", out.outer_walls);
  fill(settings, "", out.config);
  return settings.finish();
}

}  // namespace hedon
