/// Inspects the arrays of a checkpoint, whose source is not trusted.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "simulation/saved.h"

namespace hedon {

/// Checks the numbers of a checkpoint. Reads arrays by name; stores the first problem.
class Inspector {
 public:
  Inspector(const World& world, const Checkpoint& checkpoint) : world_(world), checkpoint_(checkpoint) {}

  std::string complaint;

  /// Looks first after the array found last, since most arrays are requested in order.
  const SavedArray* find(const std::string& name) const {
    const size_t count = checkpoint_.size();
    for (size_t i = 0; i < count; ++i, ++next_) {
      if (next_ >= count) next_ = 0;
      if (checkpoint_[next_].name == name) return &checkpoint_[next_];
    }
    return nullptr;
  }

  /// The numbers of an array whose type and shape have been checked.
  template <class T>
  std::vector<T> numbers(const std::string& name) const {
    const SavedArray& array = *find(name);
    std::vector<T> values(array.bytes.size() / sizeof(T));
    if (!values.empty()) memcpy(values.data(), array.bytes.data(), array.bytes.size());
    return values;
  }

  bool refuse(const std::string& text) {
    if (complaint.empty()) complaint = text;
    return false;
  }

  /// Whether an array exists, with the right type and, except where they are -1, the lengths for this config.
  template <class T>
  bool has(const std::string& name, const std::vector<int64_t>& shape) {
    const SavedArray* array = find(name);
    if (array == nullptr) return refuse(name + " is missing");
    if (array->kind != kind_of<T>() || array->size != static_cast<int32_t>(sizeof(T)))
      return refuse(name + " has numbers of another type");
    bool same = array->shape.size() == shape.size();
    for (size_t d = 0; same && d < shape.size(); ++d) same = shape[d] == -1 || shape[d] == array->shape[d];
    if (!same) return refuse(name + " has shape " + text(array->shape) + ", here it is " + text(shape));
    return true;
  }

  /// Whether all numbers of an array are within bounds; NaN is not.
  template <class T>
  bool within(const std::string& name, double low, double high) {
    return all_of<T>(name, low, high, [=](T value) {
      const double number = static_cast<double>(value);
      return number >= low && number <= high;
    });
  }

  /// Whether all numbers of an array of floats are finite.
  template <class T>
  bool finite(const std::string& name) {
    constexpr T LARGEST = std::numeric_limits<T>::max();
    return all_of<T>(name, static_cast<double>(-LARGEST), static_cast<double>(LARGEST),
                     [](T value) { return std::fabs(value) <= LARGEST; });
  }

  /// Whether the rows of a table of floats hold nothing but 0 where the count of that row is 0.
  bool zero_until_counted(const std::string& table, const std::string& count) {
    const std::vector<int64_t> counts = numbers<int64_t>(count);
    const std::span<const char> bytes = find(table)->bytes;
    const size_t row = counts.empty() ? 0 : bytes.size() / counts.size();
    for (size_t i = 0; i < counts.size(); ++i) {
      const std::span<const char> one = bytes.subspan(i * row, row);
      if (counts[i] == 0 && std::any_of(one.begin(), one.end(), [](char byte) { return byte != 0; }))
        return refuse(table + " is not 0 for an agent whose " + count + " are");
    }
    return true;
  }

  const World& world_;

 private:
  /// Large arrays have millions of numbers and almost never a bad one, so the first loop has no branch.
  template <class T, class Good>
  bool all_of(const std::string& name, double low, double high, Good&& good) {
    const SavedArray& array = *find(name);
    const size_t count = array.bytes.size() / sizeof(T);
    const auto value = [&](size_t i) {
      T number;
      memcpy(&number, array.bytes.data() + i * sizeof(T), sizeof number);
      return number;
    };
    bool all = true;
    for (size_t i = 0; i < count; ++i) all &= good(value(i));
    for (size_t i = 0; i < count && !all; ++i) {
      if (!good(value(i)))
        return refuse(name + " holds " + std::to_string(value(i)) + ", allowed is " + std::to_string(low) + " to " +
                      std::to_string(high));
    }
    return true;
  }

  static std::string text(const std::vector<int64_t>& shape) {
    std::string out = "(";
    for (const int64_t length : shape)
      out += (out.size() > 1 ? ", " : "") + (length < 0 ? "n" : std::to_string(length));
    return out + ")";
  }

  const Checkpoint& checkpoint_;
  mutable size_t next_ = 0;  ///< where `find` looks first
};

}  // namespace hedon
