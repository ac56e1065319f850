/// The network of one agent over lanes: the sparse first layer, the square layer, the heads.
///
/// Lanes are outputs and inner indices run in order, so results do not depend on the shape of a tile.
#pragma once

#include "kernel/network_table.h"
#include "lanes/elementary.h"
#include "learning/weight_pair.h"

namespace hedon {
namespace {

inline constexpr int LANES = 16;
inline constexpr int WIDTH = HIDDEN / LANES;  ///< lanes in a row of hidden units

/// Rows of 64 numbers.
struct PlainRows {
  const float* first;

  HEDON_INLINE PlainRows after(int row) const { return {first + row * HIDDEN}; }

  /// C lanes of a row from a column on.
  template <int C>
  HEDON_INLINE void read(int row, int column, Lanes* to) const {
    const float* const from = first + row * HIDDEN + column;
    unroll<C>([&](auto c) HEDON_INLINED { to[c] = load(from + c * LANES); });
  }
};

/// Rows of 64 weights in pairs: each one with the one 16 columns further.
struct PackedRows {
  const float* first;

  HEDON_INLINE PackedRows after(int row) const { return {first + row * (HIDDEN / 2)}; }

  template <int C>
  HEDON_INLINE void read(int row, int column, Lanes* to) const {
    static_assert(C % 2 == 0);
    const float* const from = first + row * (HIDDEN / 2) + column / 2;
    unroll<C / 2>([&](auto c) HEDON_INLINED {
      to[2 * c] = load(from + c * LANES);
      to[2 * c + 1] = lower_half(to[2 * c]);
    });
  }
};

/// Adds A·B to a tile of R rows and C lanes of columns. begin(r, c) gives the start of a sum, end(r, c, sum) takes the
/// sum. a   element (row r, inner k) at r * ROW_STRIDE + k * INNER_STRIDE
template <int R, int C, int ROW_STRIDE, int INNER_STRIDE, class Matrix, class Begin, class End>
HEDON_INLINE void multiply_tile(const float* a, const Matrix& b, int column, int inner, const Begin& begin,
                                const End& end) {
  Lanes total[R][C];
  unroll<R>([&](auto r) HEDON_INLINED { unroll<C>([&](auto c) HEDON_INLINED { total[r][c] = begin(r, c); }); });
#pragma GCC unroll 2
  for (int k = 0; k < inner; ++k) {
    Lanes row[C];
    b.template read<C>(k, column, row);
    unroll<R>([&](auto r) HEDON_INLINED {
      const Lanes x = broadcast(a[r * ROW_STRIDE + k * INNER_STRIDE]);
      unroll<C>([&](auto c) HEDON_INLINED { total[r][c] = multiply_add(x, row[c], total[r][c]); });
    });
  }
  unroll<R>([&](auto r) HEDON_INLINED { unroll<C>([&](auto c) HEDON_INLINED { end(r, c, total[r][c]); }); });
}

/// All of A·B: `rows` rows by 64 columns, in tiles of R rows and C lanes; the remaining rows in smaller tiles.
/// begin(row, column) and end(row, column, sum) as above, with the column counted in floats.
template <int R, int C, int ROW_STRIDE, int INNER_STRIDE, class Matrix, class Begin, class End>
HEDON_INLINE void multiply(const float* a, const Matrix& b, int rows, int inner, const Begin& begin, const End& end,
                           int first = 0) {
  int row = first;
  for (; row + R <= rows; row += R) {
    for (int column = 0; column < HIDDEN; column += C * LANES) {
      multiply_tile<R, C, ROW_STRIDE, INNER_STRIDE>(
          a + row * ROW_STRIDE, b, column, inner,
          [&](auto r, auto c) HEDON_INLINED { return begin(row + r, column + c * LANES); },
          [&](auto r, auto c, Lanes total) HEDON_INLINED { end(row + r, column + c * LANES, total); });
    }
  }
  if constexpr (R > 1) {
    if (row < rows) multiply<R / 2, C, ROW_STRIDE, INNER_STRIDE>(a, b, rows, inner, begin, end, row);
  }
}

/// See `ActingNetwork::folded_bias`. w1   the rows that will be read
template <class Matrix>
HEDON_INLINE void fold_bias(const NetworkShape& shape, const float* b1, const Matrix& w1, float* folded_bias) {
  Lanes bias[WIDTH], row[WIDTH];
  PlainRows{b1}.read<WIDTH>(0, 0, bias);
  const ObservationShape& sizes = shape.observation;
  // Ray by ray, not row by row, so that the rounding of the sum does not depend on the order of rows in memory.
  for (int32_t r = 0; r < sizes.rays; ++r) {
    for (int32_t type = 0; type < sizes.types; ++type) {
      w1.template read<WIDTH>(sizes.ray_entry(r, type), 0, row);
      unroll<WIDTH>([&](auto c) HEDON_INLINED { bias[c] = bias[c] - row[c]; });
    }
  }
  unroll<WIDTH>([&](auto c) HEDON_INLINED { store(folded_bias + c * LANES, bias[c]); });
}

/// See `NetworkKernels::pack_weights`.
HEDON_FN void pack_weights(const NetworkShape& shape, const ActingNetwork& network) {
  const float* const b1 = network.params + shape.b1();
  if (network.packed_weights == nullptr) {
    fold_bias(shape, b1, PlainRows{network.params + shape.w1()}, network.folded_bias);
    return;
  }
  for (int32_t pair = 0; pair < shape.pairs(); pair += LANES) {
    const float* const first = network.params + 2 * pair;
    for (int i = 0; i < LANES; ++i) network.packed_weights[pair + i] = pair_weights(first[i], first[LANES + i]);
  }
  fold_bias(shape, b1, PackedRows{network.packed_weights}.after(shape.w1() / HIDDEN), network.folded_bias);
}

/// Whether ray r hit the same type in all S observations. Observations of neighboring steps mostly agree, so the branch
/// is cheap.
template <int S>
HEDON_INLINE bool same_type(const PackedObservation* const* observation, int32_t r) {
  const int type = observation[0]->ray_type[r];
  int difference = 0;
  unroll<S - 1>([&](auto s) HEDON_INLINED { difference |= observation[s + 1]->ray_type[r] ^ type; });
  return difference == 0;
}

/// The first hidden layer of S observations together: one row-addition per ray, per touch and per dense entry. A row
/// that all of them read is loaded only once.
/// hidden   (S, 64), after the tanh
template <int S, class Matrix>
HEDON_INLINE void first_layer(const NetworkShape& shape, const Matrix& w1, const float* folded_bias,
                              const PackedObservation* const* observation, float* hidden) {
  const ObservationShape& sizes = shape.observation;
  Lanes total[S][WIDTH];
  unroll<S>([&](auto s) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = load(folded_bias + c * LANES); });
  });
  const auto add_row = [&](auto s, float x, const Lanes* row) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = multiply_add(broadcast(x), row[c], total[s][c]); });
  };
  Lanes row[WIDTH];
  for (int32_t r = 0; r < sizes.rays; ++r) {
    if (same_type<S>(observation, r)) {
      w1.template read<WIDTH>(sizes.ray_entry(r, observation[0]->ray_type[r]), 0, row);
      unroll<S>([&](auto s) HEDON_INLINED { add_row(s, observation[s]->ray[r], row); });
    } else {
      unroll<S>([&](auto s) HEDON_INLINED {
        w1.template read<WIDTH>(sizes.ray_entry(r, observation[s]->ray_type[r]), 0, row);
        add_row(s, observation[s]->ray[r], row);
      });
    }
  }
  const int32_t touch = sizes.ray_entries(), dense = touch + sizes.touches;
  const auto add_touched = [&](auto s, uint64_t touched, int32_t first) HEDON_INLINED {
    for (uint64_t bits = touched; bits != 0; bits &= bits - 1) {
      w1.template read<WIDTH>(first + lowest_bit(bits), 0, row);
      unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = total[s][c] + row[c]; });
    }
  };
  unroll<S>([&](auto s) HEDON_INLINED {
    add_touched(s, observation[s]->touch, touch);
    if (sizes.wide()) add_touched(s, extra_of(*observation[s]).touch, touch + 64);
  });
  for (int32_t d = 0; d < sizes.narrow_dense(); ++d) {
    w1.template read<WIDTH>(dense + d, 0, row);
    unroll<S>([&](auto s) HEDON_INLINED { add_row(s, observation[s]->dense[d], row); });
  }
  for (int32_t d = MAX_DENSE; d < sizes.dense; ++d) {
    w1.template read<WIDTH>(dense + d, 0, row);
    unroll<S>([&](auto s) HEDON_INLINED { add_row(s, extra_of(*observation[s]).dense[d - MAX_DENSE], row); });
  }
  unroll<S>([&](auto s) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { store(hidden + s * HIDDEN + c * LANES, tanh_lanes(total[s][c])); });
  });
}

/// The second hidden layer of `count` samples. hidden1, hidden2   (count, 64)
template <class Shape>
HEDON_INLINE void second_layer(const NetworkShape& shape, const float* params, const float* hidden1, int count,
                               float* hidden2) {
  const float* bias = params + shape.b2();
  multiply<Shape::rows, Shape::lanes, HIDDEN, 1>(
      hidden1, PlainRows{params + shape.w2()}, count, HIDDEN,
      [&](int, int column) HEDON_INLINED { return load(bias + column); },
      [&](int row, int column, Lanes total)
          HEDON_INLINED { store(hidden2 + row * HIDDEN + column, tanh_lanes(total)); });
}

/// Mean (2) and value of one sample. `hidden(c)` gives the second hidden layer, from registers or memory.
HEDON_INLINE void heads(const NetworkShape& shape, const float* params, const float* hidden2, float* output) {
  Lanes total[OUTPUTS];
  unroll<OUTPUTS>([&](auto o) HEDON_INLINED {
    const float* weight = params + shape.w3() + o * HIDDEN;
    total[o] = load(hidden2) * load(weight);
    unroll<WIDTH - 1>([&](auto c) HEDON_INLINED {
      total[o] = multiply_add(load(hidden2 + (c + 1) * LANES), load(weight + (c + 1) * LANES), total[o]);
    });
  });
  unroll<OUTPUTS>([&](auto o) HEDON_INLINED { output[o] = sum(total[o]) + params[shape.b3() + o]; });
}

/// weights   rows of w1, of b1, and of w2, as in `network.params` or rounded
template <class Shape, class Matrix>
HEDON_INLINE void forward_by(const NetworkShape& shape, const ActingNetwork& network, const Matrix& weights,
                             const PackedObservation& observation, float* output) {
  alignas(64) float hidden1[HIDDEN];
  alignas(64) float hidden2[HIDDEN];
  const PackedObservation* one = &observation;
  const float* const bias = network.params + shape.b2();
  first_layer<1>(shape, weights.after(shape.w1() / HIDDEN), network.folded_bias, &one, hidden1);
  multiply<1, Shape::forward_lanes, HIDDEN, 1>(
      hidden1, weights.after(shape.w2() / HIDDEN), 1, HIDDEN,
      [&](int, int column) HEDON_INLINED { return load(bias + column); },
      [&](int, int column, Lanes total) HEDON_INLINED { store(hidden2 + column, tanh_lanes(total)); });
  heads(shape, network.params, hidden2, output);
}

/// See `NetworkKernels::forward`.
template <class Shape>
HEDON_FN void forward(const NetworkShape& shape, const ActingNetwork& network, const PackedObservation& observation,
                      float* output) {
  if (network.packed_weights == nullptr) {
    forward_by<Shape>(shape, network, PlainRows{network.params}, observation, output);
  } else {
    forward_by<Shape>(shape, network, PackedRows{network.packed_weights}, observation, output);
  }
}

}  // namespace
}  // namespace hedon
