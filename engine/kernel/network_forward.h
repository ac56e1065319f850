/// The network of one agent over lanes: the sparse first layer, the square layer, the heads.
///
/// Lanes are outputs and inner indices run in order, so each number is the same whatever the shape of a tile.
#pragma once

#include "kernel/kernel.h"
#include "lanes/elementary.h"

namespace hedon {
namespace {

inline constexpr int LANES = 16;
inline constexpr int WIDTH = HIDDEN / LANES;  ///< lanes in a row of hidden units

/// Adds A·B to a tile of R rows and C lanes of columns. begin(r, c) gives what a sum starts from, end(r, c, sum) takes
/// it. a   element (row r, inner k) at r * ROW_STRIDE + k * INNER_STRIDE b   rows of 64, from the tile's first column
template <int R, int C, int ROW_STRIDE, int INNER_STRIDE, class Begin, class End>
HEDON_INLINE void multiply_tile(const float* a, const float* b, int inner, const Begin& begin, const End& end) {
  Lanes total[R][C];
  unroll<R>([&](auto r) HEDON_INLINED { unroll<C>([&](auto c) HEDON_INLINED { total[r][c] = begin(r, c); }); });
#pragma GCC unroll 2
  for (int k = 0; k < inner; ++k) {
    Lanes row[C];
    unroll<C>([&](auto c) HEDON_INLINED { row[c] = load(b + k * HIDDEN + c * LANES); });
    unroll<R>([&](auto r) HEDON_INLINED {
      const Lanes x = broadcast(a[r * ROW_STRIDE + k * INNER_STRIDE]);
      unroll<C>([&](auto c) HEDON_INLINED { total[r][c] = multiply_add(x, row[c], total[r][c]); });
    });
  }
  unroll<R>([&](auto r) HEDON_INLINED { unroll<C>([&](auto c) HEDON_INLINED { end(r, c, total[r][c]); }); });
}

/// All of A·B: `rows` rows by 64 columns, in tiles of R rows and C lanes; what is left over in tiles of fewer rows.
/// begin(row, column) and end(row, column, sum) as above, with the column counted in floats.
template <int R, int C, int ROW_STRIDE, int INNER_STRIDE, class Begin, class End>
HEDON_INLINE void multiply(const float* a, const float* b, int rows, int inner, const Begin& begin, const End& end,
                           int first = 0) {
  int row = first;
  for (; row + R <= rows; row += R) {
    for (int column = 0; column < HIDDEN; column += C * LANES) {
      multiply_tile<R, C, ROW_STRIDE, INNER_STRIDE>(
          a + row * ROW_STRIDE, b + column, inner,
          [&](auto r, auto c) HEDON_INLINED { return begin(row + r, column + c * LANES); },
          [&](auto r, auto c, Lanes total) HEDON_INLINED { end(row + r, column + c * LANES, total); });
    }
  }
  if constexpr (R > 1) {
    if (row < rows) multiply<R / 2, C, ROW_STRIDE, INNER_STRIDE>(a, b, rows, inner, begin, end, row);
  }
}

HEDON_FN void fold_bias(const NetworkShape& shape, const float* params, float* folded) {
  Lanes bias[WIDTH];
  unroll<WIDTH>([&](auto c) HEDON_INLINED { bias[c] = load(params + shape.b1() + c * LANES); });
  const ObservationShape& sizes = shape.observation;
  // Ray by ray, not row by row: the sum rounds the same wherever the rows lie.
  for (int32_t r = 0; r < sizes.rays; ++r) {
    for (int32_t type = 0; type < sizes.types; ++type) {
      const float* row = params + shape.w1() + sizes.ray_entry(r, type) * HIDDEN;
      unroll<WIDTH>([&](auto c) HEDON_INLINED { bias[c] = bias[c] - load(row + c * LANES); });
    }
  }
  unroll<WIDTH>([&](auto c) HEDON_INLINED { store(folded + c * LANES, bias[c]); });
}

/// Whether ray r hit the same type in all of S observations. Neighbors in time mostly agree, so the branch is cheap.
template <int S>
HEDON_INLINE bool same_type(const PackedObservation* const* observation, int32_t r) {
  const int type = observation[0]->ray_type[r];
  int difference = 0;
  unroll<S - 1>([&](auto s) HEDON_INLINED { difference |= observation[s + 1]->ray_type[r] ^ type; });
  return difference == 0;
}

/// The first hidden layer of S observations at once: one row-addition per ray, per touch and per dense entry. A row
/// that all of them read is loaded once.
/// hidden   (S, 64), after the tanh
template <int S>
HEDON_INLINE void first_layer(const NetworkShape& shape, const float* params, const float* folded,
                              const PackedObservation* const* observation, float* hidden) {
  const ObservationShape& sizes = shape.observation;
  Lanes total[S][WIDTH];
  unroll<S>([&](auto s) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = load(folded + c * LANES); });
  });
  const auto add_row = [&](auto s, float x, const Lanes* row) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = multiply_add(broadcast(x), row[c], total[s][c]); });
  };
  const auto load_row = [&](const float* at, Lanes* row) HEDON_INLINED {
    unroll<WIDTH>([&](auto c) HEDON_INLINED { row[c] = load(at + c * LANES); });
  };
  const float* const w1 = params + shape.w1();
  Lanes row[WIDTH];
  for (int32_t r = 0; r < sizes.rays; ++r) {
    if (same_type<S>(observation, r)) {
      load_row(w1 + sizes.ray_entry(r, observation[0]->ray_type[r]) * HIDDEN, row);
      unroll<S>([&](auto s) HEDON_INLINED { add_row(s, observation[s]->ray[r], row); });
    } else {
      unroll<S>([&](auto s) HEDON_INLINED {
        load_row(w1 + sizes.ray_entry(r, observation[s]->ray_type[r]) * HIDDEN, row);
        add_row(s, observation[s]->ray[r], row);
      });
    }
  }
  const float* group = w1 + sizes.ray_entries() * HIDDEN;
  unroll<S>([&](auto s) HEDON_INLINED {
    for (uint64_t bits = observation[s]->touch; bits != 0; bits &= bits - 1) {
      const float* row = group + lowest_bit(bits) * HIDDEN;
      unroll<WIDTH>([&](auto c) HEDON_INLINED { total[s][c] = total[s][c] + load(row + c * LANES); });
    }
  });
  group += sizes.touches * HIDDEN;
  for (int32_t d = 0; d < sizes.dense; ++d, group += HIDDEN) {
    load_row(group, row);
    unroll<S>([&](auto s) HEDON_INLINED { add_row(s, observation[s]->dense[d], row); });
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
      hidden1, params + shape.w2(), count, HIDDEN, [&](int, int column) HEDON_INLINED { return load(bias + column); },
      [&](int row, int column, Lanes total)
          HEDON_INLINED { store(hidden2 + row * HIDDEN + column, tanh_lanes(total)); });
}

/// Mean (2) and value of one sample. The second hidden layer comes in registers or memory by `hidden(c)`.
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

template <class Shape>
HEDON_FN void forward(const NetworkShape& shape, const float* params, const float* folded,
                      const PackedObservation& observation, float* output) {
  alignas(64) float hidden1[HIDDEN];
  alignas(64) float hidden2[HIDDEN];
  const PackedObservation* one = &observation;
  first_layer<1>(shape, params, folded, &one, hidden1);
  multiply<1, Shape::forward_lanes, HIDDEN, 1>(
      hidden1, params + shape.w2(), 1, HIDDEN,
      [&](int, int column) HEDON_INLINED { return load(params + shape.b2() + column); },
      [&](int, int column, Lanes total) HEDON_INLINED { store(hidden2 + column, tanh_lanes(total)); });
  heads(shape, params, hidden2, output);
}

}  // namespace
}  // namespace hedon
