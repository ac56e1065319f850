/// A team that does a few of many pieces of work at a time, so that a page can draw in between.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/team.h"

namespace hedon {

/// Runs `for_each_claimed` only over the pieces [first, last), and `once` only with the last of all pieces. Calling
/// `learn_window` with slice after slice does what one call with the team does: its pieces are independent. Each
/// member of the team has its own.
class WorkSlice {
 public:
  WorkSlice(Team& team, int32_t first, int32_t last) : team_(&team), first_(first), last_(last) {}

  int rank() const { return team_->rank(); }
  int size() const { return team_->size(); }

  template <class Body>
  void for_each_claimed(int32_t count, Body&& body) {
    count_ = count;
    team_->for_each_claimed(std::max(std::min(last_, count) - first_, 0), [&](int32_t i) { body(first_ + i); });
  }

  template <class Body>
  void once(Body&& body) {
    if (done()) team_->once(body);
  }

  /// Whether no piece is left after this slice.
  bool done() const { return last_ >= count_; }

  /// Pieces of all slices together.
  int32_t count() const { return count_; }

 private:
  Team* team_;
  int32_t first_, last_;
  int32_t count_ = 0;
};

}  // namespace hedon
