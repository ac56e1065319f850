/// Random numbers and elementary functions, for tests against published vectors and distributions.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <array>
#include <vector>

#include "base/math.h"
#include "base/random.h"
#include "binding/parts.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using DoublesIn = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using DoublesOut = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

DoublesOut own(std::vector<double> values) {
  auto* held = new std::vector<double>(std::move(values));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return DoublesOut(held->data(), {held->size()}, owner);
}

template <class F>
DoublesOut map(const DoublesIn& x, F f) {
  std::vector<double> out(x.shape(0));
  for (size_t i = 0; i < out.size(); ++i) out[i] = f(x.data()[i]);
  return own(std::move(out));
}

}  // namespace

void bind_random(nb::module_& module) {
  nb::module_ random = module.def_submodule("random", "Counter-based random numbers and elementary functions.");
  random.def(
      "philox",
      [](std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key) {
        const Random4 r = philox({{counter[0], counter[1], counter[2], counter[3]}}, key[0], key[1]);
        return std::array<uint32_t, 4>{r.word[0], r.word[1], r.word[2], r.word[3]};
      },
      nb::arg("counter"), nb::arg("key"), "Four 32-bit words from Philox4x32-10.");
  random.def(
      "draw",
      [](uint64_t seed, const char* form, int64_t count) {
        const RandomStream stream{seed, Purpose::action, 0, 0};
        const std::string_view name(form);
        std::vector<double> out(static_cast<size_t>(count));
        for (size_t i = 0; i < out.size(); ++i) {
          const Random4 r = stream.draw(static_cast<uint32_t>(i));
          if (name == "uniform")
            out[i] = to_uniform(r.word[0]);
          else if (name == "normal")
            out[i] = to_normal(r.word[0], r.word[1]).first;
          else if (name == "cauchy")
            out[i] = to_cauchy(r.word[0]);
          else if (name == "student_t")
            out[i] = to_student_t(2.0, r.word[0], r.word[1]);
          else
            throw nb::value_error("form: 'uniform', 'normal', 'cauchy' or 'student_t' (2 degrees of freedom)");
        }
        return own(std::move(out));
      },
      nb::arg("seed"), nb::arg("form"), nb::arg("count"), "`count` draws of a distribution.");
  random.def(
      "atan2",
      [](DoublesIn y, DoublesIn x) {
        if (y.shape(0) != x.shape(0)) throw nb::value_error("y and x must be equally long");
        std::vector<double> out(y.shape(0));
        for (size_t i = 0; i < out.size(); ++i) out[i] = atan2_double(y.data()[i], x.data()[i]);
        return own(std::move(out));
      },
      nb::arg("y"), nb::arg("x"));
  random.def("exp", [](DoublesIn x) { return map(x, exp_double); }, nb::arg("x"));
  random.def("log", [](DoublesIn x) { return map(x, log_double); }, nb::arg("x"));
  random.def(
      "sin",
      [](DoublesIn x) {
        return map(x, [](double v) {
          double s, c;
          sincos_double(v, &s, &c);
          return s;
        });
      },
      nb::arg("x"));
  random.def(
      "cos",
      [](DoublesIn x) {
        return map(x, [](double v) {
          double s, c;
          sincos_double(v, &s, &c);
          return c;
        });
      },
      nb::arg("x"));
}

}  // namespace hedon
