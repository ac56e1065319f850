/// Factors that change over time, for growth, capacity and hazard.
#pragma once

#include <cstdint>

#include "base/device.h"
#include "config/config.h"

namespace hedon {

/// The factor in step `step`. It is constant before the first point and after the last. With a period and linear
/// interpolation, it changes from the last point to the first point of the next period.
HEDON_FN double factor_at(const ScheduleConfig& schedule, int64_t step) {
  const int32_t count = schedule.points.count;
  if (count == 0) return 1.0;
  const int64_t time = schedule.period > 0 ? step % schedule.period : step;
  int32_t next = 0;
  while (next < count && schedule.points[next].step <= time) ++next;
  const bool wraps = schedule.period > 0;
  if ((next == 0 || next == count) && !wraps) return schedule.points[next == 0 ? 0 : count - 1].factor;
  const SchedulePoint& from = schedule.points[next == 0 ? count - 1 : next - 1];
  if (schedule.form == ScheduleForm::steps) return from.factor;
  const SchedulePoint& to = schedule.points[next == count ? 0 : next];
  const int64_t start = next == 0 ? int64_t{from.step} - schedule.period : from.step;
  const int64_t end = next == count ? int64_t{to.step} + schedule.period : to.step;
  const double share = static_cast<double>(time - start) / static_cast<double>(end - start);
  return from.factor + share * (static_cast<double>(to.factor) - from.factor);
}

}  // namespace hedon
