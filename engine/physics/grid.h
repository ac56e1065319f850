/// A uniform grid of cells. Each cell has a linked list of the items whose center was in it when they were inserted.
///
/// Filling takes time in proportion to the items and cells. Single items can be inserted and removed at any time, so
/// that a query finds a new item immediately. Items outside the area are in the cells at its edge, and queries find
/// them there.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"

namespace hedon {

struct Grid {
  Array<int32_t> head;  ///< first item of each cell, -1 if none; (columns · rows)
  Array<int32_t> next;  ///< the next item in the same cell, -1 at the end; (items)
  Array<int32_t> cell;  ///< cell of each item, -1 if it is not in the grid; (items)
  float inverse_cell;   ///< cells per length [1/u]
  int32_t columns;
  int32_t rows;
  int32_t unused;

  HEDON_FIELDS(Grid, head, next, cell, inverse_cell, columns, rows, unused)
};

/// Index of the cell along one axis; a value outside, or NaN, gives the first or last cell.
HEDON_FN int32_t cell_along(float position, float inverse_cell, int32_t cells) {
  const float at = position * inverse_cell;
  if (!(at > 0.0f)) return 0;
  return at < static_cast<float>(cells) ? static_cast<int32_t>(at) : cells - 1;
}

/// Cell of a position.
HEDON_FN int32_t cell_of(const Grid& grid, float x, float y) {
  const int32_t column = cell_along(x, grid.inverse_cell, grid.columns);
  return cell_along(y, grid.inverse_cell, grid.rows) * grid.columns + column;
}

template <class Crew>
HEDON_FN void clear_grid(const Crew& crew, const Grid& grid) {
  crew.each(0, static_cast<int32_t>(grid.head.count), [&](int32_t cell) { grid.head[cell] = -1; });
  crew.each(0, static_cast<int32_t>(grid.cell.count), [&](int32_t item) { grid.cell[item] = -1; });
}

/// Clears a grid and inserts the items of all ranks in [0, count); in each cell, they are in the order of their ranks.
/// cell(item)   of it, -1 for none
/// item(rank)   and rank(item)
template <class Crew, class Cell, class Item, class Rank>
HEDON_FN void fill_grid(const Crew& crew, const Grid& grid, int32_t count, Cell&& cell, Item&& item, Rank&& rank) {
  clear_grid(crew, grid);
  const auto key = [&](int32_t i) { return grid.cell[item(i)] = cell(item(i)); };
  crew.link(count, static_cast<int32_t>(grid.head.count), grid.head.data, grid.next.data, key, item, rank);
}

/// Removes an item; does nothing if it is not in the grid.
HEDON_FN void remove(const Grid& grid, int32_t item) {
  if (grid.cell[item] < 0) return;
  int32_t* link = &grid.head[grid.cell[item]];
  while (*link != item) link = &grid.next[*link];
  *link = grid.next[item];
  grid.cell[item] = -1;
}

/// Inserts an item at a position; removes it from its old cell first.
HEDON_FN void insert(const Grid& grid, int32_t item, float x, float y) {
  const int32_t cell = cell_of(grid, x, y);
  remove(grid, item);
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

/// Calls f(item) for a superset of the items that were inserted within `reach` [u] of a point. They come in the order
/// of the linked lists, on which results must not depend.
template <class F>
HEDON_FN void for_each_near(const Grid& grid, float x, float y, float reach, F&& f) {
  for_each_in(grid, x - reach, y - reach, x + reach, y + reach, f);
}

}  // namespace hedon
