/// A learner in the shared memory of its block, and the tiles of 2 by 4 numbers that its threads compute in registers.
#pragma once

#include "cuda/block.h"
#include "cuda/lanes.h"
#include "cuda/learning_layout.h"
#include "kernel/ppo_loss.h"

namespace hedon {
namespace {

/// Four neighboring floats, read and written together; aligned to 16 bytes.
struct __attribute__((may_alias, aligned(16))) Four {
  float v[4];
};
HEDON_INLINE Four read_four(const float* from) { return *reinterpret_cast<const Four*>(from); }
HEDON_INLINE void write_four(float* to, const Four& four) { *reinterpret_cast<Four*>(to) = four; }

/// One learner and its place in shared memory.
struct BlockUpdate {
  const NetworkShape& shape;
  const LearningConfig& config;
  LearningLayout at;
  Learner learner;  ///< the data to update, in shared memory except for moments that do not fit
  float* gradient;
  float* w2_transposed;
  float* hidden1;  ///< later the derivatives of the first layer's sums
  float* hidden2;  ///< the same for the second layer
  float* folded_bias;
  BlockSamples* samples;
  float* parts;
  float* sums;
  int32_t* index;

  HEDON_INLINE const float* params() const { return learner.params; }

  /// The i-th parameter of the network, which must follow the square layer, and its place in the gradient.
  HEDON_INLINE const float* param_after(int32_t i) const { return learner.params + i + PARAM_SHIFT; }
  HEDON_INLINE float* gradient_after(int32_t i) const { return gradient + i + GRADIENT_SHIFT; }
};

static_assert(sizeof(BlockSamples) == SAMPLE_ARRAYS * BLOCK * sizeof(float));

/// Samples or rows of a tile: so few that each thread of a block has one.
inline constexpr int TILE_ROWS = VARIANT.tile_rows;

/// As many adjacent floats as a tile has rows.
struct __attribute__((may_alias, aligned(TILE_ROWS * 4))) Column {
  float v[TILE_ROWS];
};
HEDON_INLINE Column read_column(const float* from) { return *reinterpret_cast<const Column*>(from); }

/// A tile: some samples or rows by 4 units.
struct Totals {
  float v[TILE_ROWS][4];

  HEDON_INLINE void add(int row, float x, const Four& by) {
    for (int j = 0; j < 4; ++j) v[row][j] = __builtin_fmaf(x, by.v[j], v[row][j]);
  }
  HEDON_INLINE Four row(int i) const { return {v[i][0], v[i][1], v[i][2], v[i][3]}; }
  HEDON_INLINE void set_row(int i, const Four& four) {
    for (int j = 0; j < 4; ++j) v[i][j] = four.v[j];
  }
};

inline constexpr int TILES = BLOCK / TILE_ROWS * (HIDDEN / 4);  ///< of a (64, 64) matrix

/// Calls body(row, column) for each tile of a (64, 64) matrix.
template <class Body>
HEDON_INLINE void each_tile(const Block& block, Body&& body) {
  block.each(TILES, [&](int tile) { body(tile / 16 * TILE_ROWS, tile % 16 * 4); });
}

/// The tiles of a matrix that a thread has: as in `each_tile`.
struct OwnTiles {
  static constexpr int COUNT = (TILES + BLOCK_THREADS - 1) / BLOCK_THREADS;
  Totals total[COUNT] = {};

  /// Calls body(total, row, column) for each of them.
  template <class Body>
  HEDON_INLINE void each(const Block& block, Body&& body) {
    for (int n = 0; n < COUNT; ++n) {
      const int tile = block.rank() + n * BLOCK_THREADS;
      if (tile < TILES) body(total[n], tile / 16 * TILE_ROWS, tile % 16 * 4);
    }
  }
};

/// A tile of A·B: a has its rows HIDDEN_STRIDE apart, b its rows STRIDE; both are 64 wide. Adds to `total`, in order.
template <int STRIDE>
HEDON_INLINE void multiply_rows(const float* a, const float* b, Totals& total) {
  for (int k = 0; k < HIDDEN; k += 4) {
    Four left[TILE_ROWS];
    for (int i = 0; i < TILE_ROWS; ++i) left[i] = read_four(a + i * HIDDEN_STRIDE + k);
    for (int q = 0; q < 4; ++q) {
      const Four right = read_four(b + (k + q) * STRIDE);
      for (int i = 0; i < TILE_ROWS; ++i) total.add(i, left[i].v[q], right);
    }
  }
}

/// The same of A·Bᵀ, with the columns 0, 16, 32 and 48 after the first row of b: neighboring threads read neighboring
/// rows, which begin in other banks.
HEDON_INLINE void multiply_columns(const float* a, const float* b, Totals& total) {
  for (int k = 0; k < HIDDEN; k += 4) {
    Four left[TILE_ROWS], right[4];
    for (int i = 0; i < TILE_ROWS; ++i) left[i] = read_four(a + i * HIDDEN_STRIDE + k);
    for (int j = 0; j < 4; ++j) right[j] = read_four(b + j * 16 * SQUARE_STRIDE + k);
    for (int q = 0; q < 4; ++q) {
      for (int i = 0; i < TILE_ROWS; ++i) {
        for (int j = 0; j < 4; ++j) total.v[i][j] = __builtin_fmaf(left[i].v[q], right[j].v[q], total.v[i][j]);
      }
    }
  }
}

}  // namespace
}  // namespace hedon
