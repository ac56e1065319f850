/// Single kernels: rays, and measurements of the processor.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "binding/memory.h"
#include "binding/parts.h"
#include "binding/released.h"
#include "kernel/kernel.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using Columns = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Types = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Columns of a row-major array, each in its own aligned memory, readable up to a multiple of 16.
Aligned<float> column_of(const Columns& rows, size_t column) {
  const size_t count = rows.shape(0), width = rows.shape(1);
  Aligned<float> out((count + 15) / 16 * 16);
  for (size_t i = 0; i < count; ++i) out.get()[i] = rows.data()[i * width + column];
  return out;
}

nb::tuple cast_rays(const std::string& kernel_name, Columns circles, Types circle_type, Columns segments,
                    int32_t wall_type, Columns direction, float start, float length, int64_t repeats) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const size_t rays = direction.shape(0);
  if (circles.shape(1) != 3) throw nb::value_error("circles: columns x, y, radius");
  if (segments.shape(1) != 4) throw nb::value_error("segments: columns ax, ay, bx, by");
  if (direction.shape(1) != 2 || rays < 1 || rays > PACKED_RAYS) throw nb::value_error("direction: (1 to 32, 2)");
  check_length(circle_type.size(), circles.shape(0), "circle_type");
  const Aligned<float> x = column_of(circles, 0), y = column_of(circles, 1), radius = column_of(circles, 2);
  const Aligned<float> ax = column_of(segments, 0), ay = column_of(segments, 1);
  const Aligned<float> bx = column_of(segments, 2), by = column_of(segments, 3);
  const Aligned<float> cosine(PACKED_RAYS), sine(PACKED_RAYS);
  for (size_t r = 0; r < PACKED_RAYS; ++r) {
    const size_t from = r < rays ? r : rays - 1;
    cosine.get()[r] = direction.data()[2 * from];
    sine.get()[r] = direction.data()[2 * from + 1];
  }
  const size_t count = circles.shape(0);
  Aligned<float> type((count + 15) / 16 * 16);
  Aligned<int32_t> all(count + 16);
  for (size_t i = 0; i < count; ++i) {
    type.get()[i] = static_cast<float>(circle_type.data()[i]);
    all.get()[i] = static_cast<int32_t>(i);
  }
  const RayTargets targets = {x.get(),
                              y.get(),
                              radius.get(),
                              type.get(),
                              ax.get(),
                              ay.get(),
                              bx.get(),
                              by.get(),
                              static_cast<int32_t>(segments.shape(0)),
                              static_cast<int32_t>(segments.shape(0)),
                              static_cast<float>(wall_type)};
  // For a fan at the origin with heading x, the directions of rays are their cosines and sines. Arcs have no edges.
  const Aligned<float> next(HIDDEN * HIDDEN);
  const RayFan fan = {0.0f,  0.0f,   1.0f, 0.0f, cosine.get(), sine.get(), static_cast<int32_t>(rays),
                      start, length, -1,   1.0f, 0.0f,         {},         {next.get(), HIDDEN}};
  const int32_t candidate_count = static_cast<int32_t>(count);
  const RayCandidates candidates = {{all.get(), all.get()}, {candidate_count, candidate_count}};
  alignas(64) float reading[PACKED_RAYS];
  uint8_t hit[PACKED_RAYS];
  for (int64_t i = 0; i < repeats; ++i) kernel.rays.cast_rays(targets, fan, candidates, reading, hit);
  return nb::make_tuple(to_numpy(reading, {rays}), to_numpy(hit, {rays}));
}

double calibrate(const std::string& kernel_name, int64_t rounds) {
  if (rounds < 1) throw nb::value_error("rounds: at least 1");
  const Kernel& kernel = kernel_by_name(kernel_name);
  float result = 0.5f;
  const auto before = std::chrono::steady_clock::now();
  const int64_t operations = kernel.rates.multiply_adds(rounds, &result);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - before;
  if (!(result > 0.0f)) throw std::runtime_error("a sum of positive numbers is not positive");
  return static_cast<double>(operations) / seconds.count() * 1e-9;
}

double read_rate(const std::string& kernel_name, int64_t bytes, int64_t rounds) {
  constexpr int64_t BLOCK = 64 * sizeof(float);
  if (bytes < BLOCK || rounds < 1) throw nb::value_error("bytes: at least 256; rounds: at least 1");
  const Kernel& kernel = kernel_by_name(kernel_name);
  const int64_t count = bytes / BLOCK * 64;
  const Aligned<float> values(static_cast<size_t>(count));
  for (int64_t i = 0; i < count; ++i) values.get()[i] = 1.0f;
  float total = kernel.rates.sum_floats(values.get(), count);
  const auto before = std::chrono::steady_clock::now();
  for (int64_t i = 0; i < rounds; ++i) total += kernel.rates.sum_floats(values.get(), count);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - before;
  if (!(total > 0.0f)) throw std::runtime_error("a sum of ones is not positive");
  return static_cast<double>(rounds * count * static_cast<int64_t>(sizeof(float))) / seconds.count() * 1e-9;
}

}  // namespace

void bind_kernel(nb::module_& module) {
  nb::module_ kernel = module.def_submodule("kernel", "Single kernels: one implementation per instruction set.");
  kernel.def(
      "kernel_names",
      [] {
        std::vector<std::string> names;
        for (const char* const* name = kernel_names(); *name != nullptr; ++name) names.emplace_back(*name);
        return names;
      },
      "Names of the kernels that this processor can run, best first.");
  kernel.def(
      "cast_rays", cast_rays, nb::arg("kernel"), nb::arg("circles"), nb::arg("circle_type"), nb::arg("segments"),
      nb::arg("wall_type"), nb::arg("direction"), nb::arg("start"), nb::arg("length"), nb::arg("repeats") = 1,
      "Reading + 1 and type of each ray. circles (n, 3: x, y, radius) and segments (m, 4) relative to the center; "
      "computed `repeats` times, for timing.");
  kernel.def("calibrate", calibrate, nb::arg("kernel"), nb::arg("rounds"), nb::call_guard<Released>(),
             "Multiply-adds in registers on this thread [GF/s]: the limit for the other kernels. Releases the "
             "interpreter lock.");
  kernel.def("read_rate", read_rate, nb::arg("kernel"), nb::arg("bytes"), nb::arg("rounds"), nb::call_guard<Released>(),
             "An array of `bytes` read again and again on this thread [GB/s]. Releases the interpreter lock.");
}

}  // namespace hedon
