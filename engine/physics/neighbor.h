/// The neighbor list (Verlet 1967): all pairs that may touch before any body has moved half the skin.
///
/// Its order is canonical: bodies by their rank in the caller's order, circles by slot, walls by index. Results of the
/// solver do not depend on the skin, since only overlapping pairs act and a longer list keeps their order.
#pragma once

#include <cstdint>

#include "base/status.h"
#include "physics/body.h"
#include "physics/island.h"
#include "physics/state.h"

namespace hedon {

/// Share of the skin that a body may move before the list is built again: half, minus a margin for rounding.
inline constexpr float SKIN_SHARE = 0.49f;

/// Calls f(slot) for a superset of the bodies whose centers lie within `reach` [u] of a point, including bodies that
/// moved since the last build. A body that has left the order since then is included too, unless it was removed.
template <class F>
HEDON_FN void for_each_body_near(const PhysicsState& state, float x, float y, float reach, F&& f) {
  for_each_near(state.body_grid, x, y, reach + 0.5f * state.neighbors.head[0].skin, f);
}

/// Calls f(slot) for a superset of the circles whose centers lie within `reach` [u] of a point.
template <class F>
HEDON_FN void for_each_circle_near(const PhysicsState& state, float x, float y, float reach, F&& f) {
  for_each_near(state.circle_grid, x, y, reach, f);
}

/// Keeps the first fault.
HEDON_FN void raise_fault(Fault& fault, Status status, double value) {
  if (fault.status != Status::ok) return;
  fault.status = status;
  fault.agent_id = fault.other_id = -1;
  fault.value = value;
}

/// Index of a pair in a list, -1 if it is not listed.
HEDON_FN int32_t find_pair(const PairList& list, int32_t first, int32_t second) {
  for (int32_t pair = list.start[first]; pair < list.start[first + 1]; ++pair) {
    if (list.second[pair] == second) return pair;
  }
  return -1;
}

/// Candidates of one kind, appended by rising first rank (walls: by rising wall).
struct PairBuilder {
  const PairScratch& found;
  int32_t count = 0;
  bool overflow = false;

  HEDON_FN void append(int32_t first, int32_t second) {
    if (count >= found.first.count) {
      overflow = true;
      return;
    }
    found.first[count] = first;
    found.second[count] = second;
    ++count;
  }

  /// Sorts by second what was appended since `from`.
  HEDON_FN void sort_from(int32_t from) {
    for (int32_t i = from + 1; i < count; ++i) {
      const int32_t value = found.second[i];
      int32_t at = i;
      for (; at > from && found.second[at - 1] > value; --at) found.second[at] = found.second[at - 1];
      found.second[at] = value;
    }
  }

  /// Fetches the impulses that the pairs had in the old list. `key(i, &first, &second)` names pair i there, or
  /// returns false.
  template <class Key>
  HEDON_FN void carry_over(const PairList& old, Key&& key) {
    for (int32_t i = 0; i < count; ++i) {
      int32_t first, second;
      const int32_t pair = key(i, &first, &second) ? find_pair(old, first, second) : -1;
      found.normal[i] = pair < 0 ? 0.0f : old.normal_impulse[pair];
      found.tangent[i] = pair < 0 ? 0.0f : old.tangent_impulse[pair];
    }
  }
};

HEDON_FN void find_body_pairs(const PhysicsState& state, const BodyTable& table, const PhysicsScratch& scratch,
                              const int32_t* order, int32_t count, float skin, PairBuilder& pairs) {
  const BodyState& bodies = state.bodies;
  for (int32_t rank = 0; rank < count; ++rank) {
    const int32_t slot = order[rank];
    const float radius = table.radius(slot);
    const float x = bodies.x[slot], y = bodies.y[slot];
    const int32_t from = pairs.count;
    for_each_near(state.body_grid, x, y, radius + table.max_radius() + skin, [&](int32_t other) {
      const float dx = bodies.x[other] - x, dy = bodies.y[other] - y;
      const float reach = radius + table.radius(other) + skin;
      if (dx * dx + dy * dy < reach * reach && scratch.rank[other] > rank && table.collide(slot, other))
        pairs.append(rank, scratch.rank[other]);
    });
    pairs.sort_from(from);
    for (int32_t i = from; i < pairs.count; ++i) join(scratch.parent, rank, pairs.found.second[i]);
  }
}

HEDON_FN void find_circle_pairs(const PhysicsState& state, const BodyTable& table, const int32_t* order, int32_t count,
                                float skin, PairBuilder& pairs) {
  const StaticCircles& circles = state.circles;
  for (int32_t rank = 0; rank < count; ++rank) {
    const int32_t slot = order[rank];
    const float reach = table.radius(slot) + table.circle_radius + skin;
    const float x = state.bodies.x[slot], y = state.bodies.y[slot];
    const int32_t from = pairs.count;
    for_each_near(state.circle_grid, x, y, reach, [&](int32_t circle) {
      const float dx = circles.x[circle] - x, dy = circles.y[circle] - y;
      if (dx * dx + dy * dy < reach * reach && table.collides_with_circle(slot, circle)) pairs.append(rank, circle);
    });
    pairs.sort_from(from);
  }
}

/// Follows each wall through the rows of cells, and lists the bodies on both sides of it.
HEDON_FN void find_wall_pairs(const PhysicsState& state, const BodyTable& table, const PhysicsScratch& scratch,
                              float skin, PairBuilder& pairs) {
  const Grid& grid = state.body_grid;
  const float margin = table.max_radius() + skin + 0.5f;  // covers the rounding of cells and cuts
  for (int32_t wall = 0; wall < state.walls.count; ++wall) {
    const Vec2 a = state.walls[wall].a, b = state.walls[wall].b;
    const Vec2 low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
    const int32_t first_row = cell_along(low.y - margin, grid.inverse_cell, grid.rows);
    const int32_t last_row = cell_along(high.y + margin, grid.inverse_cell, grid.rows);
    for (int32_t row = first_row; row <= last_row; ++row) {
      // The part of the wall that bodies of this row may touch; the outer rows also hold all bodies beyond them.
      const float cell = 1.0f / grid.inverse_cell;
      const float bottom = row == 0 ? low.y : static_cast<float>(row) * cell - margin;
      const float top = row == grid.rows - 1 ? high.y : static_cast<float>(row + 1) * cell + margin;
      const float rise = high.y - low.y;
      const float t0 = bottom > low.y && rise > 0.0f ? (bottom - low.y) / rise : 0.0f;
      const float t1 = top < high.y && rise > 0.0f ? (top - low.y) / rise : 1.0f;
      const float x0 = low.x + t0 * (high.x - low.x), x1 = low.x + t1 * (high.x - low.x);
      const float middle = (static_cast<float>(row) + 0.5f) * cell;
      for_each_in(grid, (x0 < x1 ? x0 : x1) - margin, middle, (x0 < x1 ? x1 : x0) + margin, middle, [&](int32_t slot) {
        const Vec2 center{state.bodies.x[slot], state.bodies.y[slot]};
        const float reach = table.radius(slot) + skin;
        if (squared_length(nearest_on_segment(a, b, center) - center) < reach * reach) {
          pairs.append(scratch.rank[slot], wall);
        }
      });
    }
  }
}

/// Moves the candidates into the list, sorted by the index of the first body; the sort is stable.
/// map(second)   the list's value for a candidate's second
template <class Map>
HEDON_FN void fill_list(const PairList& list, const PairBuilder& pairs, const Array<int32_t>& index, int32_t bodies,
                        Map&& map) {
  for (int32_t at = 0; at <= bodies; ++at) list.start[at] = 0;
  for (int32_t i = 0; i < pairs.count; ++i) ++list.start[index[pairs.found.first[i]]];
  int32_t sum = 0;
  for (int32_t at = 0; at <= bodies; ++at) {
    const int32_t here = list.start[at];
    list.start[at] = sum;
    sum += here;
  }
  for (int32_t i = 0; i < pairs.count; ++i) {
    const int32_t first = index[pairs.found.first[i]];
    const int32_t at = list.start[first]++;
    list.first[at] = first;
    list.second[at] = map(pairs.found.second[i]);
    list.normal_impulse[at] = pairs.found.normal[i];
    list.tangent_impulse[at] = pairs.found.tangent[i];
    list.mark[at] = 0;
  }
  for (int32_t at = bodies; at > 0; --at) list.start[at] = list.start[at - 1];
  list.start[0] = 0;
}

/// Clears the grids and inserts all bodies of the order and all present circles.
HEDON_FN void fill_grids(const PhysicsState& state, const int32_t* order, int32_t count) {
  clear_grid(state.body_grid);
  clear_grid(state.circle_grid);
  for (int32_t rank = count - 1; rank >= 0; --rank) {
    const int32_t slot = order[rank];
    insert(state.body_grid, slot, state.bodies.x[slot], state.bodies.y[slot]);
  }
  for (int64_t slot = state.circles.x.count - 1; slot >= 0; --slot) {
    if (state.circles.present[slot]) {
      insert(state.circle_grid, static_cast<int32_t>(slot), state.circles.x[slot], state.circles.y[slot]);
    }
  }
}

/// Lists all pairs with a separation below `skin` [u]. Replaces the old list, but keeps its impulses.
/// Fault: neighbor_overflow, with the number of pairs that the list can hold; then the old list stays.
HEDON_FN void build_neighbors(const PhysicsState& state, const BodyTable& table, const PhysicsScratch& scratch,
                              const int32_t* order, int32_t count, float skin, Fault& fault) {
  const NeighborList& list = state.neighbors;
  NeighborHead& head = list.head[0];
  fill_grids(state, order, count);
  for (int32_t rank = 0; rank < count; ++rank) {
    scratch.rank[order[rank]] = rank;
    scratch.parent[rank] = rank;
    scratch.work[rank] = 0;
  }
  PairBuilder bodies{scratch.bodies}, circles{scratch.circles}, walls{scratch.walls};
  find_body_pairs(state, table, scratch, order, count, skin, bodies);
  find_circle_pairs(state, table, order, count, skin, circles);
  find_wall_pairs(state, table, scratch, skin, walls);
  for (const PairBuilder* pairs : {&bodies, &circles, &walls}) {
    if (pairs->overflow) {
      raise_fault(fault, Status::neighbor_overflow, static_cast<double>(pairs->found.first.count));
      return;
    }
    for (int32_t i = 0; i < pairs->count; ++i) ++scratch.work[pairs->found.first[i]];
  }

  const auto old_index = [&](int32_t rank) { return list.index[order[rank]]; };
  bodies.carry_over(list.bodies, [&](int32_t i, int32_t* first, int32_t* second) {
    const int32_t a = old_index(bodies.found.first[i]), b = old_index(bodies.found.second[i]);
    *first = a < b ? a : b;
    *second = a < b ? b : a;
    return *first >= 0;
  });
  const auto carry_static = [&](PairBuilder& pairs, const PairList& old) {
    pairs.carry_over(old, [&](int32_t i, int32_t* first, int32_t* second) {
      *first = old_index(pairs.found.first[i]);
      *second = pairs.found.second[i];
      return *first >= 0;
    });
  };
  carry_static(circles, list.circles);
  carry_static(walls, list.walls);

  for (int32_t index = 0; index < head.bodies; ++index) list.index[list.slot[index]] = -1;
  assign_indices(head, scratch, count);
  for (int32_t rank = 0; rank < count; ++rank) {
    const int32_t index = scratch.new_index[rank], slot = order[rank];
    list.slot[index] = slot;
    list.index[slot] = index;
    list.build_x[index] = state.bodies.x[slot];
    list.build_y[index] = state.bodies.y[slot];
  }
  const auto same = [](int32_t second) { return second; };
  fill_list(list.bodies, bodies, scratch.new_index, count, [&](int32_t rank) { return scratch.new_index[rank]; });
  fill_list(list.circles, circles, scratch.new_index, count, same);
  fill_list(list.walls, walls, scratch.new_index, count, same);
  head.skin = skin;
  ++head.builds;
}

/// Calls f(slot of the body, slot of the circle, mark) for each listed pair of a body and a circle.
template <class F>
HEDON_FN void for_each_circle_pair(const NeighborList& list, F&& f) {
  const int32_t pairs = list.circles.start[list.head[0].bodies];
  for (int32_t pair = 0; pair < pairs; ++pair) {
    f(list.slot[list.circles.first[pair]], list.circles.second[pair], list.circles.mark[pair]);
  }
}

}  // namespace hedon
