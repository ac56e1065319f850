/// A group of one member that does a few of many pieces at a time, so that a page can draw in between.
#pragma once

#include <cstdint>

namespace hedon {

/// Runs `for_each_claimed` only over the pieces [first, last), and `once` only with the last of all pieces. Calling
/// `learn_window` with portion after portion does what one call with a whole team does: its pieces are independent.
class Portion {
 public:
  Portion(int32_t first, int32_t last) : first_(first), last_(last) {}

  int rank() const { return 0; }
  int size() const { return 1; }

  template <class Body>
  void for_each_claimed(int32_t count, Body&& body) {
    count_ = count;
    for (int32_t i = first_; i < last_ && i < count; ++i) body(i);
  }

  template <class Body>
  void once(Body&& body) {
    if (done()) body();
  }

  /// Whether no piece is left after this portion.
  bool done() const { return last_ >= count_; }

  /// Pieces of all portions together.
  int32_t count() const { return count_; }

 private:
  int32_t first_, last_;
  int32_t count_ = 0;
};

}  // namespace hedon
