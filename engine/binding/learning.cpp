/// Single kernels and learning, so that tests and benchmarks can call them from NumPy.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <tuple>
#include <vector>

#include "binding/config.h"
#include "binding/memory.h"
#include "binding/parts.h"
#include "kernel/kernel.h"
#include "learning/init.h"
#include "learning/weight_pair.h"
#include "simulation/learn.h"

namespace nb = nanobind;

namespace hedon {
namespace {

using Floats = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using FloatPairs = nb::ndarray<const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using FloatRows = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Ints = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IntRows = nb::ndarray<const int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Bytes = nb::ndarray<const uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using FloatsOut = nb::ndarray<nb::numpy, float>;
using BytesOut = nb::ndarray<nb::numpy, uint8_t>;
using ObservationSizes = std::tuple<int32_t, int32_t, int32_t, int32_t>;

NetworkShape to_shape(const ObservationSizes& sizes) {
  const auto [rays, types, touches, dense] = sizes;
  if (rays < 0 || rays > PACKED_RAYS) throw nb::value_error("shape: rays must be 0 to 32");
  if (types < 1 || types > 255) throw nb::value_error("shape: types must be 1 to 255");
  constexpr int32_t MOST = MAX_DENSE + MAX_EXTRA_DENSE;
  if (touches < 0 || touches > 128) throw nb::value_error("shape: touches must be 0 to 128");
  if (dense < 0 || dense > MOST) throw nb::value_error("shape: dense must be 0 to 20");
  ObservationShape shape{rays, types, touches, dense, NARROW_LINES};
  if (shape.wide()) shape.lines = WIDE_LINES;
  return {shape};
}

/// Packed observations in aligned memory, after a check of their width.
struct Observations {
  Aligned<ObservationLine> lines;
  const ObservationShape& shape;

  Observations(const NetworkShape& network, const Bytes& packed)
      : lines(reinterpret_cast<const ObservationLine*>(packed.data()),
              packed.shape(0) * static_cast<size_t>(network.observation.lines)),
        shape(network.observation) {
    check_length(packed.shape(1), static_cast<size_t>(shape.lines) * sizeof(ObservationLine), "observation's bytes");
  }

  const PackedObservation* first() const { return reinterpret_cast<const PackedObservation*>(lines.get()); }
  const PackedObservation& at(size_t i) const { return *observation_at(shape, first(), static_cast<int64_t>(i)); }
};

/// A rollout's arrays, copied to aligned memory after a check of their sizes and indices.
struct BatchArrays {
  Observations observation;
  PpoBatch batch;

  BatchArrays(const NetworkShape& shape, const Bytes& packed, const FloatPairs& action, const Floats& log_prob,
              const Floats& first, const Floats& second)
      : observation(shape, packed) {
    const size_t count = packed.shape(0);
    check_length(action.shape(0), count, "action");
    check_length(log_prob.shape(0), count, "log_prob");
    check_length(first.shape(0), count, "advantage or value");
    check_length(second.shape(0), count, "target or reward");
    const uint64_t touches = static_cast<uint64_t>(shape.observation.touches);
    for (size_t i = 0; i < count; ++i) {
      const PackedObservation& one = observation.at(i);
      for (int r = 0; r < shape.observation.rays; ++r) {
        if (one.ray_type[r] >= shape.observation.types) throw nb::value_error("observation: ray_type out of range");
      }
      if (touches < 64 && (one.touch >> touches) != 0) throw nb::value_error("observation: touch out of range");
    }
    batch = {observation.first(),        action.data(), log_prob.data(), first.data(), second.data(), nullptr,
             static_cast<int32_t>(count)};
  }
};

void check_order(const int32_t* order, size_t length, int32_t count) {
  for (size_t i = 0; i < length; ++i) {
    if (order[i] < 0 || order[i] >= count) throw nb::value_error("order: index out of range");
  }
}

void check_minibatch(const LearningConfig& config, int32_t count) {
  if (config.minibatch_size < 1 || count % config.minibatch_size != 0) {
    throw nb::value_error("minibatch_size must divide the number of samples");
  }
}

/// Copies of one learner's arrays, returned as a tuple (params, first_moment, second_moment, updates, losses).
struct LearnerArrays {
  Aligned<float> params, first_moment, second_moment;
  int64_t updates;
  size_t size;

  LearnerArrays(const Floats& p, const Floats& m, const Floats& v, int64_t steps)
      : params(p.data(), p.size()),
        first_moment(m.data(), m.size()),
        second_moment(v.data(), v.size()),
        updates(steps),
        size(p.size()) {
    check_length(m.size(), size, "first_moment");
    check_length(v.size(), size, "second_moment");
    if (size % 16 != 0) throw nb::value_error("params: the length must be a multiple of 16");
  }
  Learner view() { return {params.get(), first_moment.get(), second_moment.get(), &updates}; }
  nb::tuple result(const PpoLoss& loss) const {
    return nb::make_tuple(to_numpy(params.get(), {size}), to_numpy(first_moment.get(), {size}),
                          to_numpy(second_moment.get(), {size}), updates,
                          nb::make_tuple(loss.policy, loss.value, loss.entropy));
  }
};

BytesOut pack_all(FloatRows ray, nb::ndarray<const uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu> ray_type,
                  nb::ndarray<const uint64_t, nb::c_contig, nb::device::cpu> touch, FloatRows dense) {
  const size_t count = ray.shape(0), rays = ray.shape(1), words = touch.ndim() == 2 ? touch.shape(1) : 1,
               width = dense.shape(1);
  constexpr size_t NARROW = MAX_DENSE, MOST = MAX_DENSE + MAX_EXTRA_DENSE;
  if (rays > PACKED_RAYS || ray_type.shape(1) != rays) throw nb::value_error("ray: at most 32 columns, as ray_type");
  if (width > MOST) throw nb::value_error("dense: at most 20 columns");
  if (words < 1 || words > 2) throw nb::value_error("touch: 1 or 2 columns of 64 bits");
  check_length(ray_type.shape(0), count, "ray_type");
  check_length(touch.shape(0), count, "touch");
  check_length(dense.shape(0), count, "dense");
  const size_t lines = words > 1 || width > NARROW ? WIDE_LINES : NARROW_LINES;
  Aligned<ObservationLine> packed(count * lines);
  for (size_t i = 0; i < count; ++i) {
    PackedObservation& one = *reinterpret_cast<PackedObservation*>(packed.get() + i * lines);
    std::memcpy(one.ray, ray.data() + i * rays, rays * sizeof(float));
    std::memcpy(one.ray_type, ray_type.data() + i * rays, rays);
    one.touch = touch.data()[i * words];
    std::memcpy(one.dense, dense.data() + i * width, std::min(width, NARROW) * sizeof(float));
    if (words > 1) extra_of(one).touch = touch.data()[i * words + 1];
    if (width > NARROW)
      std::memcpy(extra_of(one).dense, dense.data() + i * width + NARROW, (width - NARROW) * sizeof(float));
  }
  return to_numpy(reinterpret_cast<const uint8_t*>(packed.get()), {count, lines * sizeof(ObservationLine)});
}

FloatsOut unpack_all(ObservationSizes sizes, Bytes packed) {
  const NetworkShape shape = to_shape(sizes);
  const size_t count = packed.shape(0), width = static_cast<size_t>(shape.observation.size());
  const Observations observation(shape, packed);
  std::vector<float> full(count * width);
  for (size_t i = 0; i < count; ++i) unpack(shape.observation, observation.at(i), full.data() + i * width);
  return to_numpy(full.data(), {count, width});
}

FloatsOut pair_all(const Floats& first, const Floats& second) {
  check_length(second.size(), first.size(), "second");
  std::vector<float> pairs(first.size());
  for (size_t i = 0; i < pairs.size(); ++i) pairs[i] = pair_weights(first.data()[i], second.data()[i]);
  return to_numpy(pairs.data(), {pairs.size()});
}

FloatsOut forward_all(const std::string& kernel_name, ObservationSizes sizes, Floats params, Bytes packed,
                      bool rounded) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const NetworkShape shape = to_shape(sizes);
  check_length(params.size(), static_cast<size_t>(shape.size()), "params");
  const size_t count = packed.shape(0);
  const Observations observation(shape, packed);
  Aligned<float> weights(params.data(), params.size());
  Aligned<float> folded_bias(HIDDEN);
  Aligned<float> packed_weights(static_cast<size_t>(shape.pairs()));
  const ActingNetwork network = {weights.get(), folded_bias.get(), rounded ? packed_weights.get() : nullptr};
  std::vector<float> output(count * OUTPUTS);
  kernel.network.pack_weights(shape, network);
  for (size_t i = 0; i < count; ++i) {
    kernel.network.forward(shape, network, observation.at(i), output.data() + i * OUTPUTS);
  }
  return to_numpy(output.data(), {count, size_t{OUTPUTS}});
}

nb::tuple gradient(const std::string& kernel_name, ObservationSizes sizes, nb::dict settings, Floats params,
                   Bytes observation, FloatPairs action, Floats log_prob, Floats advantage, Floats target, Ints order) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const NetworkShape shape = to_shape(sizes);
  auto config = to_config<LearningConfig>(settings);
  check_length(params.size(), static_cast<size_t>(shape.size()), "params");
  const BatchArrays arrays(shape, observation, action, log_prob, advantage, target);
  check_order(order.data(), order.size(), arrays.batch.count);
  if (order.size() == 0) throw nb::value_error("order: empty");
  config.minibatch_size = static_cast<int32_t>(order.size());
  const Aligned<float> weights(params.data(), params.size());
  const Aligned<float> scratch(static_cast<size_t>(ppo_scratch_size(shape)));
  const Aligned<float> out(params.size());
  const PpoLoss loss =
      kernel.network.gradient(shape, config, weights.get(), arrays.batch, order.data(), scratch.get(), out.get());
  return nb::make_tuple(to_numpy(out.get(), {params.size()}), nb::make_tuple(loss.policy, loss.value, loss.entropy));
}

nb::tuple adam(const std::string& kernel_name, nb::dict settings, Floats gradient, Floats params, Floats first_moment,
               Floats second_moment, int64_t updates) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const auto config = to_config<LearningConfig>(settings);
  check_length(gradient.size(), params.size(), "gradient");
  const Aligned<float> slope(gradient.data(), gradient.size());
  LearnerArrays learner(params, first_moment, second_moment, updates);
  kernel.network.adam(config, static_cast<int32_t>(params.size()), slope.get(), learner.view());
  return learner.result({});
}

nb::tuple update(const std::string& kernel_name, ObservationSizes sizes, nb::dict settings, Floats params,
                 Floats first_moment, Floats second_moment, int64_t updates, Bytes observation, FloatPairs action,
                 Floats log_prob, Floats advantage, Floats target, IntRows order) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const NetworkShape shape = to_shape(sizes);
  const auto config = to_config<LearningConfig>(settings);
  check_length(params.size(), static_cast<size_t>(shape.size()), "params");
  BatchArrays arrays(shape, observation, action, log_prob, advantage, target);
  check_minibatch(config, arrays.batch.count);
  check_length(order.shape(0), static_cast<size_t>(config.update_epochs), "order");
  check_length(order.shape(1), static_cast<size_t>(arrays.batch.count), "order[0]");
  check_order(order.data(), order.size(), arrays.batch.count);
  arrays.batch.order = order.data();
  const Aligned<float> scratch(static_cast<size_t>(ppo_scratch_size(shape)));
  LearnerArrays learner(params, first_moment, second_moment, updates);
  return learner.result(kernel.network.update(shape, config, arrays.batch, scratch.get(), learner.view()));
}

nb::tuple learn_once(const std::string& kernel_name, ObservationSizes sizes, nb::dict settings, Floats params,
                     Floats first_moment, Floats second_moment, int64_t updates, Bytes observation, FloatPairs action,
                     Floats log_prob, Floats value, Floats reward, float bootstrap, uint64_t seed, uint32_t agent_id,
                     uint32_t step) {
  const Kernel& kernel = kernel_by_name(kernel_name);
  const NetworkShape shape = to_shape(sizes);
  const auto config = to_config<LearningConfig>(settings);
  check_length(params.size(), static_cast<size_t>(shape.size()), "params");
  const BatchArrays arrays(shape, observation, action, log_prob, value, reward);
  check_minibatch(config, arrays.batch.count);
  const Rollout rollout = {
      arrays.batch.observation, action.data(), log_prob.data(), value.data(), reward.data(), bootstrap,
      arrays.batch.count};
  const Aligned<float> scratch(static_cast<size_t>(learn_scratch_size(shape, config, arrays.batch.count)));
  LearnerArrays learner(params, first_moment, second_moment, updates);
  return learner.result(learn(kernel.network, shape, config, rollout, {seed, Purpose::minibatch, agent_id, step},
                              scratch.get(), learner.view()));
}

}  // namespace

void bind_learning(nb::module_& module) {
  nb::module_ learning = module.def_submodule("learning", "Network, PPO and GAE as single functions, for each kernel.");
  learning.def(
      "param_count", [](ObservationSizes sizes) { return to_shape(sizes).size(); }, nb::arg("shape"),
      "Floats of a network's flat parameter array; `shape` is (rays, types, touches, dense).");
  learning.def(
      "pack", pack_all, nb::arg("ray"), nb::arg("ray_type"), nb::arg("touch"), nb::arg("dense"),
      "Packed observations (n, 192), or (n, 256) if they are wide, from reading + 1 and type of each ray, touch bits "
      "(n, 1 or 2) and dense entries.");
  learning.def("unpack", unpack_all, nb::arg("shape"), nb::arg("observation"), "Full observations (n, size).");
  learning.def("pair_weights", pair_all, nb::arg("first"), nb::arg("second"),
               "Two weights in the bits of each float: the lower 16 are the second in bfloat16, the whole is near the "
               "first.");
  learning.def("forward", forward_all, nb::arg("kernel"), nb::arg("shape"), nb::arg("params"), nb::arg("observation"),
               nb::arg("rounded") = false,
               "Mean (2) and value of each packed observation: (n, 3), by weights as they are or rounded in pairs.");
  learning.def("gradient", gradient, nb::arg("kernel"), nb::arg("shape"), nb::arg("config"), nb::arg("params"),
               nb::arg("observation"), nb::arg("action"), nb::arg("log_prob"), nb::arg("advantage"), nb::arg("target"),
               nb::arg("order"), "Gradient and (policy, value, entropy) of the minibatch of the samples in `order`.");
  learning.def("adam", adam, nb::arg("kernel"), nb::arg("config"), nb::arg("gradient"), nb::arg("params"),
               nb::arg("first_moment"), nb::arg("second_moment"), nb::arg("updates"), "One Adam step.");
  learning.def("update", update, nb::arg("kernel"), nb::arg("shape"), nb::arg("config"), nb::arg("params"),
               nb::arg("first_moment"), nb::arg("second_moment"), nb::arg("updates"), nb::arg("observation"),
               nb::arg("action"), nb::arg("log_prob"), nb::arg("advantage"), nb::arg("target"), nb::arg("order"),
               "All epochs and minibatches, in the given order (epochs, n).");
  learning.def("learn", learn_once, nb::arg("kernel"), nb::arg("shape"), nb::arg("config"), nb::arg("params"),
               nb::arg("first_moment"), nb::arg("second_moment"), nb::arg("updates"), nb::arg("observation"),
               nb::arg("action"), nb::arg("log_prob"), nb::arg("value"), nb::arg("reward"), nb::arg("bootstrap"),
               nb::arg("seed"), nb::arg("agent_id"), nb::arg("step"), "Advantages, order and update of one learner.");
  learning.def(
      "gae",
      [](nb::dict settings, Floats reward, Floats value, float bootstrap) {
        check_length(value.size(), reward.size(), "value");
        std::vector<float> advantage(reward.size()), target(reward.size());
        estimate_advantage(to_config<LearningConfig>(settings), reward.data(), value.data(), bootstrap,
                           static_cast<int32_t>(reward.size()), advantage.data(), target.data());
        return nb::make_tuple(to_numpy(advantage.data(), {reward.size()}), to_numpy(target.data(), {reward.size()}));
      },
      nb::arg("config"), nb::arg("reward"), nb::arg("value"), nb::arg("bootstrap"),
      "Advantage and value target of each step.");
  learning.def(
      "permutation",
      [](uint64_t seed, uint32_t agent_id, uint32_t step, int32_t count, int32_t epochs) {
        if (count < 0 || epochs < 0) throw nb::value_error("count and epochs must not be negative");
        const size_t rows = static_cast<size_t>(epochs), length = static_cast<size_t>(count);
        std::vector<int32_t> order(rows * length);
        uint32_t index = 0;
        for (size_t e = 0; e < rows; ++e) {
          permute({seed, Purpose::minibatch, agent_id, step}, count, index, order.data() + e * length);
        }
        return to_numpy(order.data(), {rows, length});
      },
      nb::arg("seed"), nb::arg("agent_id"), nb::arg("step"), nb::arg("count"), nb::arg("epochs"),
      "The order (epochs, count) that `learn` uses.");
  learning.def(
      "init_network",
      [](ObservationSizes sizes, uint64_t seed, uint32_t agent_id, uint32_t step) {
        const NetworkShape shape = to_shape(sizes);
        std::vector<float> params(static_cast<size_t>(shape.size()));
        init_network(shape, {seed, Purpose::network, agent_id, step}, params.data());
        return to_numpy(params.data(), {params.size()});
      },
      nb::arg("shape"), nb::arg("seed"), nb::arg("agent_id") = 0, nb::arg("step") = 0, "Initial parameters.");
}

}  // namespace hedon
