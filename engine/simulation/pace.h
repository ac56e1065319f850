/// Decides, for each stretch of steps, whether a team steps a world together or leaves it to one member.
///
/// The members of a team wait for one another several times per step. If other programs use the processors too, a
/// member that has to wait for a processor delays the whole team, and a single member is faster. Both ways give the
/// same bits, so the choice may depend on measured times: the faster way is used, and the other is tried from time to
/// time.
#pragma once

#include <chrono>
#include <cstdint>

#include "base/team.h"

namespace hedon {

class Pace {
 public:
  /// Steps until the next decision: a few milliseconds long; in a large world a single step.
  int64_t stretch() const {
    const double seconds = together_ > alone_ ? together_ : alone_;
    const double steps = seconds > 0.0 ? SECONDS / seconds : 1.0;
    return steps < 1.0 ? 1 : (steps > LONGEST ? LONGEST : static_cast<int64_t>(steps));
  }

  /// Whether the next stretch is stepped together.
  bool together() const {
    if (count_ < START) return count_ % 2 == 0;
    const bool faster = together_ <= alone_;
    return count_ % TRIAL == TRIAL - 1 ? !faster : faster;
  }

  /// Records how long a stretch took [s per step]. A disturbance makes a stretch longer, never shorter. So a shorter
  /// time is accepted immediately, and a longer one gradually.
  void note(bool together, double seconds) {
    double& known = together ? together_ : alone_;
    known = known == 0.0 || seconds < known ? seconds : known + WEIGHT * (seconds - known);
    ++count_;
  }

 private:
  static constexpr double SECONDS = 0.008;  ///< of a stretch
  static constexpr int64_t LONGEST = 32;    ///< steps of a stretch
  static constexpr int64_t START = 4;       ///< number of first stretches, which alternate between both ways
  static constexpr int64_t TRIAL = 64;      ///< after those, every 64th stretch tries the other way: costs about 1 %
  static constexpr double WEIGHT = 0.25;    ///< weight of a longer time in the estimate

  double together_ = 0.0;  ///< 0 while unknown
  double alone_ = 0.0;
  int64_t count_ = 0;
};

/// Steps a world for up to `count` steps, but at most a stretch, or until `step_once(members)` says that the world is
/// over. Returns `count` or the length of the stretch, if that is shorter. All members of the team call it.
template <class StepOnce>
int64_t step_at_pace(Team& team, Pace& pace, int64_t count, StepOnce&& step_once) {
  const auto go = [&](Team& members) {
    for (int64_t i = 0; i < count && step_once(members); ++i) continue;
  };
  if (team.size() == 1) {
    go(team);
    return count;
  }
  const int64_t stretch = pace.stretch();
  if (count > stretch) count = stretch;
  // `note` changes the data for the decision; the barriers below delay it until all members have decided.
  const auto begun = std::chrono::steady_clock::now();
  const bool together = pace.together();
  if (together)
    go(team);
  else
    team.barrier();
  team.once([&] {
    if (!together) {
      TeamState one;
      Team alone(one, 0);
      go(alone);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begun;
    pace.note(together, seconds.count() / static_cast<double>(count));
  });
  return count;
}

}  // namespace hedon
