/// A uniform grid of cells, each with a chain of the items whose center lay in it when they were put there.
///
/// Filling costs time in proportion to the items and cells. Single items may be put in and taken out at any
/// time, so that a query sees a newcomer at once. Items outside the area belong to the cells at its edge; queries reach
/// them there.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"

namespace hedon {

struct Grid {
  Array<int32_t> head;  ///< first item of each cell, -1 if none; (columns · rows)
  Array<int32_t> next;  ///< the item that follows in the same cell, -1 at the end; (items)
  Array<int32_t> cell;  ///< where each item is, -1 if it is not in the grid; (items)
  float inverse_cell;   ///< cells per length [1/u]
  int32_t columns;
  int32_t rows;
  int32_t unused;

  HEDON_FIELDS(Grid, head, next, cell, inverse_cell, columns, rows, unused)
};

/// Index of the cell along one axis; what lies outside, or is not a number, falls into the first or last.
HEDON_FN int32_t cell_along(float position, float inverse_cell, int32_t cells) {
  const float at = position * inverse_cell;
  if (!(at > 0.0f)) return 0;
  return at < static_cast<float>(cells) ? static_cast<int32_t>(at) : cells - 1;
}

HEDON_FN void clear_grid(const Grid& grid) {
  for (int64_t cell = 0; cell < grid.head.count; ++cell) grid.head[cell] = -1;
  for (int64_t item = 0; item < grid.cell.count; ++item) grid.cell[item] = -1;
}

/// Takes an item out; nothing happens if it is not in.
HEDON_FN void remove(const Grid& grid, int32_t item) {
  if (grid.cell[item] < 0) return;
  int32_t* link = &grid.head[grid.cell[item]];
  while (*link != item) link = &grid.next[*link];
  *link = grid.next[item];
  grid.cell[item] = -1;
}

/// Puts an item at a place, from wherever it was before.
HEDON_FN void insert(const Grid& grid, int32_t item, float x, float y) {
  const int32_t column = cell_along(x, grid.inverse_cell, grid.columns);
  const int32_t row = cell_along(y, grid.inverse_cell, grid.rows);
  remove(grid, item);
  const int32_t cell = row * grid.columns + column;
  grid.next[item] = grid.head[cell];
  grid.head[cell] = item;
  grid.cell[item] = cell;
}

/// Calls f(item) for each item of the cells that the rectangle touches: a superset of the items within it.
template <class F>
HEDON_FN void for_each_in(const Grid& grid, float low_x, float low_y, float high_x, float high_y, F&& f) {
  const int32_t first_column = cell_along(low_x, grid.inverse_cell, grid.columns);
  const int32_t last_column = cell_along(high_x, grid.inverse_cell, grid.columns);
  const int32_t first_row = cell_along(low_y, grid.inverse_cell, grid.rows);
  const int32_t last_row = cell_along(high_y, grid.inverse_cell, grid.rows);
  for (int32_t row = first_row; row <= last_row; ++row) {
    for (int32_t column = first_column; column <= last_column; ++column) {
      int32_t item = grid.head[static_cast<int64_t>(row) * grid.columns + column];
      for (; item >= 0; item = grid.next[item]) f(item);
    }
  }
}

/// Calls f(item) for a superset of the items that were put within `reach` [u] of a point. Their order is that of
/// the chains: what is computed from them must not depend on it.
template <class F>
HEDON_FN void for_each_near(const Grid& grid, float x, float y, float reach, F&& f) {
  for_each_in(grid, x - reach, y - reach, x + reach, y + reach, f);
}

}  // namespace hedon
