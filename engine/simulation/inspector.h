/// Looks at the arrays of a checkpoint, which may come from anyone.
#pragma once

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "simulation/saved.h"

namespace hedon {

/// Checks the numbers of a checkpoint. Reads arrays by name; keeps the first problem.
class Inspector {
 public:
  Inspector(const World& world, const Checkpoint& checkpoint) : world_(world), checkpoint_(checkpoint) {}

  std::string complaint;

  const SavedArray* find(const std::string& name) const {
    for (const SavedArray& array : checkpoint_) {
      if (array.name == name) return &array;
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

  /// Whether an array is there, with the right type and, unless -1, the lengths for this config.
  template <class T>
  bool has(const std::string& name, const std::vector<int64_t>& shape) {
    const SavedArray* array = find(name);
    if (array == nullptr) return refuse(name + " is missing");
    const SavedArray wanted = make_saved<T>(name, {0});
    if (array->kind != wanted.kind || array->size != wanted.size) return refuse(name + " has numbers of another type");
    bool same = array->shape.size() == shape.size();
    for (size_t d = 0; same && d < shape.size(); ++d) same = shape[d] == -1 || shape[d] == array->shape[d];
    if (!same) return refuse(name + " has shape " + text(array->shape) + ", here it is " + text(shape));
    return true;
  }

  /// Whether all numbers of an array are within bounds; NaN is not.
  template <class T>
  bool within(const std::string& name, double low, double high) {
    for (const T value : numbers<T>(name)) {
      const double number = static_cast<double>(value);
      if (!(number >= low && number <= high)) {
        return refuse(name + " holds " + std::to_string(number) + ", allowed is " + std::to_string(low) + " to " +
                      std::to_string(high));
      }
    }
    return true;
  }

  const World& world_;

 private:
  static std::string text(const std::vector<int64_t>& shape) {
    std::string out = "(";
    for (const int64_t length : shape)
      out += (out.size() > 1 ? ", " : "") + (length < 0 ? "n" : std::to_string(length));
    return out + ")";
  }

  const Checkpoint& checkpoint_;
};

}  // namespace hedon
