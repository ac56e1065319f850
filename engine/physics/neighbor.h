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

/// Calls f(slot) for a superset of the bodies whose centers are within `reach` [u] of a point, including bodies that
/// moved since the last build. A body that has left the order since then is included too, unless it was removed.
template <class F>
HEDON_FN void for_each_body_near(const PhysicsState& state, float x, float y, float reach, F&& f) {
  for_each_near(state.body_grid, x, y, reach + 0.5f * state.neighbors.head[0].skin, f);
}

/// Calls f(slot) for a superset of the circles whose centers are within `reach` [u] of a point.
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

/// Candidates of one kind, by rising first rank (walls: by rising wall).
struct PairBuilder {
  const PairScratch& found;
  int32_t count = 0;  ///< including candidates for which there is no room

  HEDON_FN int32_t room() const { return static_cast<int32_t>(found.first.count); }

  HEDON_FN void keep(int32_t at, int32_t first, int32_t second) const {
    if (at >= room()) return;
    found.first[at] = first;
    found.second[at] = second;
  }

  /// Sorts a range by second.
  HEDON_FN void sort(int32_t from, int32_t to) const {
    for (int32_t i = from + 1; i < to && i < room(); ++i) {
      const int32_t value = found.second[i];
      int32_t at = i;
      for (; at > from && found.second[at - 1] > value; --at) found.second[at] = found.second[at - 1];
      found.second[at] = value;
    }
  }

  /// Lists the seconds that find(rank, add) adds for each rank; adds their number to work[rank].
  template <class Crew, class Find>
  HEDON_FN void collect(const Crew& crew, int32_t ranks, const Array<int32_t>& work, Find&& find) {
    count = crew.collect(
        ranks, find, [&](int32_t at, int32_t rank, int32_t second) { keep(at, rank, second); },
        [&](int32_t rank, int32_t from, int32_t to) {
          sort(from, to);
          work[rank] += to - from;
        });
  }

  /// Fetches the impulses that the pairs had in the old list. `key(i, &first, &second)` names pair i there, or
  /// returns false.
  template <class Crew, class Key>
  HEDON_FN void carry_over(const Crew& crew, const PairList& old, Key&& key) {
    crew.each(0, count, [&](int32_t i) {
      int32_t first, second;
      const int32_t pair = key(i, &first, &second) ? find_pair(old, first, second) : -1;
      found.normal[i] = pair < 0 ? 0.0f : old.normal_impulse[pair];
      found.tangent[i] = pair < 0 ? 0.0f : old.tangent_impulse[pair];
    });
  }
};

template <class Crew>
HEDON_FN void find_body_pairs(const Crew& crew, const PhysicsState& state, const BodyTable& table,
                              const PhysicsScratch& scratch, const int32_t* order, int32_t count, float skin,
                              PairBuilder& pairs) {
  pairs.collect(crew, count, scratch.work, [&](int32_t rank, auto&& add) {
    const int32_t slot = order[rank];
    const float radius = radius_of(state, table, slot);
    const Vec2 center{state.bodies.x[slot], state.bodies.y[slot]};
    const float widest = radius + table.max_radius() + skin;
    for_each_near(state.body_grid, scratch.bodies_by_cell, center, widest, [&](int32_t other, Vec2 place) {
      // One branch, since each condition holds for about half of the bodies and would often be mispredicted.
      const float squared = squared_length(place - center);
      if (!((squared < widest * widest) & (other > rank))) return;
      const float reach = radius + radius_of(state, table, order[other]) + skin;
      if (squared < reach * reach && table.collide(slot, order[other])) add(other);
    });
  });
}

template <class Crew>
HEDON_FN void find_circle_pairs(const Crew& crew, const PhysicsState& state, const BodyTable& table,
                                const PhysicsScratch& scratch, const int32_t* order, int32_t count, float skin,
                                PairBuilder& pairs) {
  pairs.collect(crew, count, scratch.work, [&](int32_t rank, auto&& add) {
    const int32_t slot = order[rank];
    const float reach = radius_of(state, table, slot) + table.circle_radius + skin;
    const Vec2 center{state.bodies.x[slot], state.bodies.y[slot]};
    for_each_near(state.circle_grid, scratch.circles_by_cell, center, reach, [&](int32_t circle, Vec2 place) {
      if (squared_length(place - center) < reach * reach && table.collides_with_circle(slot, circle)) add(circle);
    });
  });
}

/// Follows a wall through the rows of cells; calls add(rank) for the bodies on both sides of it.
template <class Add>
HEDON_FN void find_bodies_at(const PhysicsState& state, const BodyTable& table, const PhysicsScratch& scratch,
                             const int32_t* order, float skin, int32_t wall, Add&& add) {
  const Grid& grid = state.body_grid;
  const float margin = table.max_radius() + skin + 0.5f;  // covers the rounding of cells and cuts
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
    const float left = (x0 < x1 ? x0 : x1) - margin, right = (x0 < x1 ? x1 : x0) + margin;
    for_each_in(grid, scratch.bodies_by_cell, left, middle, right, middle, [&](int32_t rank, Vec2 center) {
      const float reach = radius_of(state, table, order[rank]) + skin;
      if (squared_length(nearest_on_segment(a, b, center) - center) < reach * reach) add(rank);
    });
  }
}

/// Moves the candidates into the list, sorted by the index of the first body; the sort is stable.
/// map(second)   the list's value for a candidate's second
template <class Crew, class Map>
HEDON_FN void fill_list(const Crew& crew, const PairList& list, const PairBuilder& pairs, const Array<int32_t>& index,
                        int32_t bodies, Map&& map) {
  const PairScratch& found = pairs.found;
  const auto index_of_first = [&](int32_t i) { return index[found.first[i]]; };
  const auto place = [&](int32_t i, int32_t at, int32_t first) {
    list.first[at] = first;
    list.second[at] = map(found.second[i]);
    list.normal_impulse[at] = found.normal[i];
    list.tangent_impulse[at] = found.tangent[i];
    list.mark[at] = 0;
  };
  crew.sort(pairs.count, bodies, list.start.data, found.first.data, index_of_first, place);
}

/// Fills the grids with all bodies of the order and all present circles.
template <class Crew>
HEDON_FN void fill_grids(const Crew& crew, const PhysicsState& state, const PhysicsScratch& scratch,
                         const int32_t* order, int32_t count) {
  const StaticCircles& circles = state.circles;
  const BodyState& bodies = state.bodies;
  fill_grid(
      crew, state.body_grid, scratch.bodies_by_cell, count, [&](int32_t rank) { return order[rank]; },
      [](int32_t) { return true; }, [&](int32_t slot) { return Vec2{bodies.x[slot], bodies.y[slot]}; });
  fill_grid(
      crew, state.circle_grid, scratch.circles_by_cell, static_cast<int32_t>(circles.x.count),
      [](int32_t slot) { return slot; }, [&](int32_t slot) { return circles.present[slot] != 0; },
      [&](int32_t slot) { return Vec2{circles.x[slot], circles.y[slot]}; });
}

/// Lists all pairs with a separation below `skin` [u]. Replaces the old list, but keeps its impulses.
/// Fault: neighbor_overflow, with the number of pairs that the list can hold; then the old list stays.
template <class Crew>
HEDON_FN void build_neighbors(const Crew& crew, const PhysicsState& state, const BodyTable& table,
                              const PhysicsScratch& scratch, const int32_t* order, int32_t count, float skin,
                              Fault& fault) {
  const NeighborList& list = state.neighbors;
  NeighborHead& head = list.head[0];
  crew.each(0, count, [&](int32_t rank) {
    scratch.parent[rank] = rank;
    scratch.work[rank] = 0;
  });
  fill_grids(crew, state, scratch, order, count);
  PairBuilder bodies{scratch.bodies}, circles{scratch.circles}, walls{scratch.walls};
  find_body_pairs(crew, state, table, scratch, order, count, skin, bodies);
  find_circle_pairs(crew, state, table, scratch, order, count, skin, circles);
  walls.count = crew.collect(
      static_cast<int32_t>(state.walls.count),
      [&](int32_t wall, auto&& add) { find_bodies_at(state, table, scratch, order, skin, wall, add); },
      [&](int32_t at, int32_t wall, int32_t rank) { walls.keep(at, rank, wall); }, [](int32_t, int32_t, int32_t) {});
  for (const PairBuilder* pairs : {&bodies, &circles, &walls}) {
    if (pairs->count <= pairs->room()) continue;
    crew.once([&] { raise_fault(fault, Status::neighbor_overflow, static_cast<double>(pairs->room())); });
    return;
  }
  crew.once([&] {
    for (int32_t i = 0; i < bodies.count; ++i) join(scratch.parent, bodies.found.first[i], bodies.found.second[i]);
    for (int32_t i = 0; i < walls.count; ++i) ++scratch.work[walls.found.first[i]];
  });

  const auto old_index = [&](int32_t rank) { return list.index[order[rank]]; };
  bodies.carry_over(crew, list.bodies, [&](int32_t i, int32_t* first, int32_t* second) {
    const int32_t a = old_index(bodies.found.first[i]), b = old_index(bodies.found.second[i]);
    *first = a < b ? a : b;
    *second = a < b ? b : a;
    return *first >= 0;
  });
  const auto carry_static = [&](PairBuilder& pairs, const PairList& old) {
    pairs.carry_over(crew, old, [&](int32_t i, int32_t* first, int32_t* second) {
      *first = old_index(pairs.found.first[i]);
      *second = pairs.found.second[i];
      return *first >= 0;
    });
  };
  carry_static(circles, list.circles);
  carry_static(walls, list.walls);

  crew.each(0, head.bodies, [&](int32_t index) { list.index[list.slot[index]] = -1; });
  crew.once([&] { assign_indices(head, scratch, count); });
  crew.each(0, count, [&](int32_t rank) {
    const int32_t index = scratch.new_index[rank], slot = order[rank];
    list.slot[index] = slot;
    list.index[slot] = index;
    list.build_x[index] = state.bodies.x[slot];
    list.build_y[index] = state.bodies.y[slot];
  });
  const auto same = [](int32_t second) { return second; };
  fill_list(crew, list.bodies, bodies, scratch.new_index, count, [&](int32_t rank) { return scratch.new_index[rank]; });
  fill_list(crew, list.circles, circles, scratch.new_index, count, same);
  fill_list(crew, list.walls, walls, scratch.new_index, count, same);
  crew.once([&] {
    head.skin = skin;
    ++head.builds;
  });
}

/// Calls f(slot of the body, slot of the circle) for each listed pair of a body and a circle that has a mark.
template <class F>
HEDON_FN void for_each_marked_circle(const NeighborList& list, F&& f) {
  const int32_t pairs = list.circles.start[list.head[0].bodies];
  for (int32_t pair = 0; pair < pairs; ++pair) {
    if (list.circles.mark[pair] != 0) f(list.slot[list.circles.first[pair]], list.circles.second[pair]);
  }
}

}  // namespace hedon
