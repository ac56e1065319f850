/// A uniform grid of cells. Each cell has a linked list of the items whose center was in it when they were inserted.
///
/// Filling takes time in proportion to the items and cells. Single items can be inserted and removed at any time, so
/// that a query finds a new item immediately. Items outside the area are in the cells at its edge, and queries find
/// them there. Filling also sorts the items by cell, for the queries of a whole neighbor list.
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/vec2.h"

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

/// The items of a grid sorted by cell, so that the cells of a row follow one another in memory.
struct CellOrder {
  Array<int32_t> start;  ///< first place of each cell; (columns · rows + 1)
  Array<int32_t> rank;   ///< of the item at each place, ascending within a cell; (items)
  Array<Vec2> position;  ///< of the item at each place; (items) [u]
  Array<int32_t> work;   ///< (items)

  HEDON_FIELDS(CellOrder, start, rank, position, work)
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

/// Clears a grid, sorts the items of all ranks in [0, count) by cell, and links them in that order.
/// item(rank)       ascending ranks are the order within a cell
/// present(item)    whether it belongs in the grid
/// position(item)   [u]
template <class Crew, class Item, class Present, class Position>
HEDON_FN void fill_grid(const Crew& crew, const Grid& grid, const CellOrder& order, int32_t count, Item&& item,
                        Present&& present, Position&& position) {
  clear_grid(crew, grid);
  const auto cell = [&](int32_t rank) {
    const int32_t one = item(rank);
    if (!present(one)) return -1;
    const Vec2 center = position(one);
    return grid.cell[one] = cell_of(grid, center.x, center.y);
  };
  const auto place = [&](int32_t rank, int32_t at, int32_t) {
    order.rank[at] = rank;
    order.position[at] = position(item(rank));
  };
  const int32_t cells = static_cast<int32_t>(grid.head.count);
  crew.sort(count, cells, order.start.data, order.work.data, cell, place);
  crew.each(0, order.start[cells], [&](int32_t at) {
    const int32_t one = item(order.rank[at]), of = grid.cell[one];
    if (at == order.start[of]) grid.head[of] = one;
    grid.next[one] = at + 1 < order.start[of + 1] ? item(order.rank[at + 1]) : -1;
  });
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

/// Calls f(first, last) for each row of cells that the rectangle touches, with the indices of the first and last cell.
template <class F>
HEDON_FN void for_each_row(const Grid& grid, float low_x, float low_y, float high_x, float high_y, F&& f) {
  const int32_t first_column = cell_along(low_x, grid.inverse_cell, grid.columns);
  const int32_t last_column = cell_along(high_x, grid.inverse_cell, grid.columns);
  const int32_t first_row = cell_along(low_y, grid.inverse_cell, grid.rows);
  const int32_t last_row = cell_along(high_y, grid.inverse_cell, grid.rows);
  for (int32_t row = first_row; row <= last_row; ++row)
    f(row * grid.columns + first_column, row * grid.columns + last_column);
}

/// Calls f(item) for a superset of the items that were inserted within `reach` [u] of a point. They come in the order
/// of the linked lists, on which results must not depend.
template <class F>
HEDON_FN void for_each_near(const Grid& grid, float x, float y, float reach, F&& f) {
  for_each_row(grid, x - reach, y - reach, x + reach, y + reach, [&](int32_t first, int32_t last) {
    for (int32_t cell = first; cell <= last; ++cell) {
      for (int32_t item = grid.head[cell]; item >= 0; item = grid.next[item]) f(item);
    }
  });
}

/// Calls f(rank, position) for each item of the cells that the rectangle touches, as they were when the grid was
/// filled.
template <class F>
HEDON_FN void for_each_in(const Grid& grid, const CellOrder& order, float low_x, float low_y, float high_x,
                          float high_y, F&& f) {
  for_each_row(grid, low_x, low_y, high_x, high_y, [&](int32_t first, int32_t last) {
    for (int32_t at = order.start[first]; at < order.start[last + 1]; ++at) f(order.rank[at], order.position[at]);
  });
}

/// The same for the cells within `reach` [u] of a point.
template <class F>
HEDON_FN void for_each_near(const Grid& grid, const CellOrder& order, Vec2 center, float reach, F&& f) {
  for_each_in(grid, order, center.x - reach, center.y - reach, center.x + reach, center.y + reach, f);
}

}  // namespace hedon
