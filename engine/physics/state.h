/// All data that the physics keeps between steps, and its scratch memory, as views of the caller's memory.
///
/// `visit_state` and `visit_scratch` list every array: they call visit(name, array, count), which the caller uses to
/// allocate, save, compare and bind. The state must be kept between steps; scratch need not be.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "base/array.h"
#include "base/crew.h"
#include "base/fields.h"
#include "base/vec2.h"
#include "config/schema.h"
#include "physics/body.h"
#include "physics/contact.h"
#include "physics/grid.h"

namespace hedon {

inline constexpr int MAX_BATCHES = 32;  ///< independent parts of one step, for as many threads
inline constexpr int COLORS = 32;       ///< of contacts between bodies

/// Pairs that may touch before the list is built again. Pairs with the same first body are consecutive.
struct PairList {
  Array<int32_t> start;          ///< first pair of each body, by index; (bodies + 1)
  Array<int32_t> first;          ///< index of the first body
  Array<int32_t> second;         ///< index of the second body, slot of the circle, or index of the wall
  Array<float> normal_impulse;   ///< accumulated, per mass of a body, >= 0 [u/s]
  Array<float> tangent_impulse;  ///< accumulated, per mass of a body [u/s]
  Array<uint8_t> mark;           ///< the visitor's note in this step; cleared when a step begins

  HEDON_FIELDS(PairList, start, first, second, normal_impulse, tangent_impulse, mark)
};

/// The counts and flags of the neighbor list.
struct NeighborHead {
  int32_t bodies;                        ///< in the list
  int32_t batches;                       ///< in use
  int32_t stale;                         ///< 1: build again before the next step; `mark_stale` sets it too
  float skin;                            ///< of the last build [u]
  float free_path;                       ///< distance that the fastest body could move in the last step [u]
  int32_t moved;                         ///< lists in a row that only motion made stale; at most UNCHANGED_LISTS
  int64_t builds;                        ///< so far
  int64_t repeats;                       ///< steps tried again because a body moved too far for the skin
  int32_t batch_start[MAX_BATCHES + 2];  ///< first index of each batch; the last entry is not used

  HEDON_FIELDS(NeighborHead, bodies, batches, stale, skin, free_path, moved, builds, repeats, batch_start)
};

/// The pairs that may touch, and the bodies in the order in which the physics processes them (their *index*).
struct NeighborList {
  Array<NeighborHead> head;  ///< (1)
  Array<int32_t> slot;       ///< of the body at each index
  Array<int32_t> index;      ///< of each slot, -1 if it holds no listed body
  Array<float> build_x;      ///< position of the body at each index at the last build [u]
  Array<float> build_y;
  PairList bodies;   ///< first and second: indices
  PairList circles;  ///< second: slot of the circle
  PairList walls;    ///< second: index of the wall

  HEDON_FIELDS(NeighborList, head, slot, index, build_x, build_y, bodies, circles, walls)
};

struct PhysicsState {
  BodyState bodies;
  Array<BodyShape> shape;  ///< by slot, if bodies have individual shapes
  StaticCircles circles;
  Array<Segment> walls;
  int32_t outer_walls;  ///< number of outer walls, which come first: a closed polygon, clockwise, around the bodies
  int32_t unused;
  Grid body_grid;    ///< bodies by slot, at their positions of the last build or insertion
  Grid circle_grid;  ///< circles by slot
  NeighborList neighbors;

  HEDON_FIELDS(PhysicsState, bodies, shape, circles, walls, outer_walls, unused, body_grid, circle_grid, neighbors)
};

HEDON_FN const BodyShape& shape_of(const PhysicsState& state, const BodyTable& table, int32_t slot) {
  return table.own != 0 ? state.shape[slot] : table.shape[table.body_class(slot)];
}
HEDON_FN float radius_of(const PhysicsState& state, const BodyTable& table, int32_t slot) {
  return shape_of(state, table, slot).radius;
}

/// Pairs found while a list is built, and the impulses of the listed pairs while a step is tried.
struct PairScratch {
  Array<int32_t> first;   ///< rank
  Array<int32_t> second;  ///< rank, slot or index
  Array<float> normal;    ///< [u/s]
  Array<float> tangent;   ///< [u/s]

  HEDON_FIELDS(PairScratch, first, second, normal, tangent)
};

/// Results of one batch for its try of a step.
struct BatchReport {
  float squared_moved;  ///< largest squared distance of a body from its position at the last build; infinite if not
                        ///< finite
  float squared_speed;  ///< largest squared speed at the end
  float squared_force;  ///< largest squared force; if bodies differ, the equivalent for the lightest
  float unused;

  HEDON_FIELDS(BatchReport, squared_moved, squared_speed, squared_force, unused)
};

struct PhysicsScratch {
  CellOrder bodies_by_cell;    ///< the grids as they were filled for the last build
  CellOrder circles_by_cell;   ///< with slots as ranks
  Array<int32_t> parent;       ///< union-find over ranks
  Array<int32_t> work;         ///< pairs and bodies of the island, by the rank of its root
  Array<int32_t> batch;        ///< of the island, by the rank of its root
  Array<int32_t> new_index;    ///< of each rank
  Array<Vec2> position;        ///< by index [u]
  Array<Motion> motion;        ///< by index
  Array<Motion> change;        ///< by index: changes by contacts in a pass of the solver jacobi
  Array<float> angle;          ///< by index, not wrapped within a step [rad]
  Array<uint32_t> colors;      ///< by index: colors of the contacts of the body
  Array<int32_t> active;       ///< pairs of bodies that touch in this substep
  Array<int32_t> color;        ///< of each active pair, and its number within the color
  Array<int32_t> color_start;  ///< first contact of each color of each batch; (MAX_BATCHES · 33)
  PairScratch bodies;
  PairScratch circles;
  PairScratch walls;
  Array<BodyShape> shape;                ///< by index; none if bodies are alike
  Array<BodyContact> body_contacts;      ///< none if bodies differ
  Array<MixedContact> mixed_contacts;    ///< none if bodies are alike
  Array<StaticContact> static_contacts;  ///< with circles, then with walls
  Array<BatchReport> reports;            ///< (MAX_BATCHES)

  HEDON_FIELDS(PhysicsScratch, bodies_by_cell, circles_by_cell, parent, work, batch, new_index, position, motion,
               change, angle, colors, active, color, color_start, bodies, circles, walls, shape, body_contacts,
               mixed_contacts, static_contacts, reports)
};

/// The sizes of the arrays.
struct PhysicsCapacity {
  int64_t bodies;
  int64_t circles;
  int64_t walls;
  int64_t body_pairs;
  int64_t circle_pairs;
  int64_t wall_pairs;
  int32_t columns;
  int32_t rows;
  float cell;     ///< side of a grid cell [u]
  float skin;     ///< skin that the capacities are for [u]
  int32_t mixed;  ///< 1 if bodies differ
  int32_t own;    ///< 1 if they have individual shapes

  HEDON_FIELDS(PhysicsCapacity, bodies, circles, walls, body_pairs, circle_pairs, wall_pairs, columns, rows, cell, skin,
               mixed, own)
};

/// Capacities for an arena. Discs that do not overlap form a limited number of pairs: within a skin of 20 u (twice the
/// radius) of a body with radius 10 u there are at most 22 others, and half of them count here; 16 leaves room for
/// overlap. Around a circle there are fewer than 24 bodies. In a convex corner, a body is near its chords and two
/// walls. With the solver jacobi, a crowd can burst: for one substep a body moves at up to 250 u/s, which needs a skin
/// of 50 u and more. There is room for all pairs of up to 200 bodies, and for the same number of neighbors of each body
/// in a larger world. Among obstacles, more sides can be near a body than the two of a corner, and a body that genes
/// have made large is near more chords of a round corner. A light body hit by a heavy one can need a wider skin than
/// these numbers allow for, which in a small world covers almost everything: each list has room for `few` pairs.
HEDON_FN PhysicsCapacity physics_capacity(int64_t bodies, int64_t circles, int64_t walls, float width, float height,
                                          const BodyTable& table, const PhysicsConfig& config) {
  const bool bursts = config.solver == PhysicsSolver::jacobi;
  const float skin = config.neighbor_skin;
  PhysicsCapacity capacity{};
  capacity.bodies = bodies;
  capacity.circles = circles;
  capacity.walls = walls;
  // A large disc can have more small neighbors.
  const float ratio = table.max_radius() / table.min_radius();
  const int64_t wide = static_cast<int64_t>(ceilf(ratio * ratio));
  const auto room = [](int64_t usual, int64_t all) {
    const int64_t few = 8192, enough = usual > few ? usual : few;
    return (enough < all ? enough : all) + 1;
  };
  capacity.body_pairs = room((bursts ? 100 : 16) * wide * bodies, bodies * (bodies - 1) / 2);
  capacity.circle_pairs = room((bursts ? 200 : 24) * wide * circles, bodies * circles);
  const bool crowded = bursts || table.first_obstacle < walls || table.own != 0;
  capacity.wall_pairs = room((crowded ? 32 : 8) * bodies, bodies * walls);
  // Cells as wide as the search range, but at most a few per item in an almost empty arena.
  const float even = sqrtf(width * height / static_cast<float>(4 * (bodies + circles) + 1));
  const float search = 2.0f * table.max_radius() + skin;
  capacity.own = table.own;
  capacity.mixed = table.classes > 1 || table.own != 0 ? 1 : 0;
  capacity.cell = even > search ? even : search;
  capacity.columns = static_cast<int32_t>(width / capacity.cell) + 1;
  capacity.rows = static_cast<int32_t>(height / capacity.cell) + 1;
  capacity.skin = skin;
  return capacity;
}

template <class T, class Visit>
void visit_arrays(T& arrays, int64_t count, Visit&& visit) {
  T::for_each_field([&](const char* name, auto member) { visit(name, arrays.*member, count); });
}

template <class Visit>
void visit_pairs(PairList& list, int64_t bodies, int64_t pairs, Visit&& visit) {
  visit("start", list.start, bodies + 1);
  visit("first", list.first, pairs);
  visit("second", list.second, pairs);
  visit("normal_impulse", list.normal_impulse, pairs);
  visit("tangent_impulse", list.tangent_impulse, pairs);
  visit("mark", list.mark, pairs);
}

/// Calls visit(name, array, count) for each array that must be kept between steps. Names repeat between groups; their
/// order is fixed. Zeroed memory, then `init_physics`, then bodies give a valid state.
template <class Visit>
void visit_state(PhysicsState& state, const PhysicsCapacity& capacity, Visit&& visit) {
  const int64_t cells = static_cast<int64_t>(capacity.columns) * capacity.rows;
  visit_arrays(state.bodies, capacity.bodies, visit);
  visit("shape", state.shape, capacity.own != 0 ? capacity.bodies : 0);
  visit_arrays(state.circles, capacity.circles, visit);
  visit("walls", state.walls, capacity.walls);
  visit("body_grid.head", state.body_grid.head, cells);
  visit("body_grid.next", state.body_grid.next, capacity.bodies);
  visit("body_grid.cell", state.body_grid.cell, capacity.bodies);
  visit("circle_grid.head", state.circle_grid.head, cells);
  visit("circle_grid.next", state.circle_grid.next, capacity.circles);
  visit("circle_grid.cell", state.circle_grid.cell, capacity.circles);
  NeighborList& list = state.neighbors;
  visit("head", list.head, int64_t{1});
  visit("slot", list.slot, capacity.bodies);
  visit("index", list.index, capacity.bodies);
  visit("build_x", list.build_x, capacity.bodies);
  visit("build_y", list.build_y, capacity.bodies);
  visit_pairs(list.bodies, capacity.bodies, capacity.body_pairs, visit);
  visit_pairs(list.circles, capacity.bodies, capacity.circle_pairs, visit);
  visit_pairs(list.walls, capacity.bodies, capacity.wall_pairs, visit);
}

template <class Visit>
void visit_cells(CellOrder& order, const PhysicsCapacity& capacity, int64_t items, Visit&& visit) {
  visit("start", order.start, int64_t{capacity.columns} * capacity.rows + 1);
  visit("rank", order.rank, items);
  visit("position", order.position, items);
  visit("work", order.work, items);
}

/// Calls visit(name, array, count) for each array that is needed only within a step.
template <class Visit>
void visit_scratch(PhysicsScratch& scratch, const PhysicsCapacity& capacity, Visit&& visit) {
  visit_cells(scratch.bodies_by_cell, capacity, capacity.bodies, visit);
  visit_cells(scratch.circles_by_cell, capacity, capacity.circles, visit);
  visit("parent", scratch.parent, capacity.bodies);
  visit("work", scratch.work, capacity.bodies);
  visit("batch", scratch.batch, capacity.bodies);
  visit("new_index", scratch.new_index, capacity.bodies);
  visit("position", scratch.position, capacity.bodies);
  visit("motion", scratch.motion, capacity.bodies);
  visit("change", scratch.change, capacity.bodies);
  visit("angle", scratch.angle, capacity.bodies);
  visit("colors", scratch.colors, capacity.bodies);
  visit("active", scratch.active, capacity.body_pairs);
  visit("color", scratch.color, capacity.body_pairs);
  visit("color_start", scratch.color_start, int64_t{MAX_BATCHES} * (COLORS + 1));
  visit_arrays(scratch.bodies, capacity.body_pairs, visit);
  visit_arrays(scratch.circles, capacity.circle_pairs, visit);
  visit_arrays(scratch.walls, capacity.wall_pairs, visit);
  const bool mixed = capacity.mixed != 0;
  visit("shape", scratch.shape, mixed ? capacity.bodies : 0);
  visit("body_contacts", scratch.body_contacts, mixed ? 0 : capacity.body_pairs);
  visit("mixed_contacts", scratch.mixed_contacts, mixed ? capacity.body_pairs : 0);
  visit("static_contacts", scratch.static_contacts, capacity.circle_pairs + capacity.wall_pairs);
  visit("reports", scratch.reports, int64_t{MAX_BATCHES});
}

/// Makes zeroed memory a valid state without bodies or circles: empty grids of the capacity's shape, a stale list.
/// After a restore, only the shapes of the grids must be set: `set_grid_shape`.
HEDON_FN void set_grid_shape(PhysicsState& state, const PhysicsCapacity& capacity) {
  for (Grid* grid : {&state.body_grid, &state.circle_grid}) {
    grid->inverse_cell = 1.0f / capacity.cell;
    grid->columns = capacity.columns;
    grid->rows = capacity.rows;
  }
}

/// Call this after a change of the order, a position, a circle or a wall: the next step builds its list again.
HEDON_FN void mark_stale(const PhysicsState& state) {
  state.neighbors.head[0].stale = 1;
  state.neighbors.head[0].moved = 0;
}

HEDON_FN void init_physics(PhysicsState& state, const PhysicsCapacity& capacity) {
  set_grid_shape(state, capacity);
  clear_grid(Alone{}, state.body_grid);
  clear_grid(Alone{}, state.circle_grid);
  for (int64_t slot = 0; slot < state.neighbors.index.count; ++slot) state.neighbors.index[slot] = -1;
  mark_stale(state);
}

}  // namespace hedon
