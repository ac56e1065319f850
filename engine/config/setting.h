/// Building blocks of settings: choices with their names, limits of numbers, and pairs.
#pragma once

#include <concepts>
#include <cstdint>

#include "base/fields.h"
#include "base/vec2.h"

namespace hedon {

/// Names of an enumeration's values, for programs that fill a config from text.
template <class E>
struct EnumNames;

/// An enumeration whose values are named like their identifiers.
#define HEDON_ENUM(Enum, ...)                                                               \
  enum class Enum : int32_t { __VA_ARGS__ };                                                \
  template <>                                                                               \
  struct EnumNames<Enum> {                                                                  \
    static constexpr const char* text[] = {HEDON_EACH(HEDON_ENUM_NAME, Enum, __VA_ARGS__)}; \
  };
#define HEDON_ENUM_NAME(Enum, value) #value,

/// The numbers that a setting allows. A struct of settings has `LIMITS`, one for each field. The limit of a list
/// applies to all its numbers, the limit of a schedule to its factors; fields without numbers of their own have
/// `Limit()`.
struct Limit {
  double low = 0.0, high = 0.0;
  bool above = false;  ///< `low` itself is not allowed
  bool below = false;  ///< `high` itself is not allowed

  static constexpr Limit from(double low, double high) { return {low, high, false, false}; }
  static constexpr Limit over(double low, double high) { return {low, high, true, false}; }
  static constexpr Limit under(double low, double high) { return {low, high, false, true}; }

  /// False for NaN.
  constexpr bool allows(double value) const {
    return (above ? value > low : value >= low) && (below ? value < high : value <= high);
  }
};

/// The factor of a schedule, starting at a step.
struct SchedulePoint {
  int32_t step;
  float factor;
};

template <class T>
concept Pair = std::same_as<T, Vec2> || std::same_as<T, SchedulePoint>;

/// Calls visit(index, number) for both numbers of a pair, which may be const.
template <class P, class Visit>
void for_each_part(P& pair, Visit&& visit) {
  if constexpr (requires { pair.step; }) {
    visit(0, pair.step);
    visit(1, pair.factor);
  } else {
    visit(0, pair.x);
    visit(1, pair.y);
  }
}

}  // namespace hedon
