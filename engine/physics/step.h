/// One step of the physics: forces, damping, contacts, and the resulting motion.
///
/// Every contact in every substep is reported to the caller's visitor:
///   visitor.on_start(slot)   before a body's first substep of each try of a step: discard all data about the body
///   visitor.on_contact(crew, kind, body, other, direction, angle, bit, mark)
///     crew       the threads that work on the body's island; they may report contacts of one body at the same time
///     body       slot of the body; a pair of bodies is reported for each of them
///     other      slot of the other body or circle, or index of the wall
///     direction  from the body's center to the contact, unit vector in the world's frame
///     angle      of the body in this substep [rad]: its angle before the step plus its rotation since then
///     mark       a byte of the pair, 0 when the step begins, free for the visitor's use
///     bit        a bit for the mark that distinguishes the two bodies of a pair: FIRST or SECOND
/// So a visitor may write data of the pair, and set bits of the body with `crew.set_bits`.
#pragma once

#include <cstdint>
#include <limits>

#include "base/status.h"
#include "base/team.h"
#include "physics/detect.h"
#include "physics/jacobi.h"
#include "physics/neighbor.h"
#include "physics/sequential.h"
#include "physics/solver.h"
#include "physics/state.h"

namespace hedon {

/// Copies a batch's bodies and impulses to scratch memory for the substeps, and adds the forces of the first substep.
template <class Bodies, class Crew, class Visitor>
HEDON_FN void load_batch(const Batch<Bodies, Crew>& batch, const BodyForce& force, BatchReport& report,
                         Visitor& visitor) {
  const PhysicsState& state = batch.state;
  const PhysicsScratch& scratch = batch.scratch;
  const BatchRange& range = batch.range;
  const float dt = batch.c.dt;
  const NeighborList& list = state.neighbors;
  const BodyState& bodies = state.bodies;
  batch.each_body([&](int32_t index) {
    const int32_t slot = list.slot[index];
    const float push_x = force.x[slot], push_y = force.y[slot];
    batch.bodies.note(index, slot);
    const float inverse_mass = batch.bodies.inverse_mass(index), inverse_inertia = batch.bodies.inverse_inertia(index);
    scratch.position[index] = {bodies.x[slot], bodies.y[slot]};
    scratch.angle[index] = bodies.angle[slot];
    scratch.motion[index] = {bodies.velocity_x[slot] + push_x * inverse_mass * dt,
                             bodies.velocity_y[slot] + push_y * inverse_mass * dt,
                             bodies.angular_velocity[slot] + force.torque[slot] * inverse_inertia * dt, 0.0f};
    const float squared_force = batch.bodies.for_lightest(index, push_x * push_x + push_y * push_y);
    if (squared_force > report.squared_force) report.squared_force = squared_force;
    visitor.on_start(slot);
  });
  const auto load_pairs = [&](const PairList& pairs, const PairScratch& work, int32_t first, int32_t last) {
    batch.crew.each(first, last, [&](int32_t pair) {
      work.normal[pair] = pairs.normal_impulse[pair];
      work.tangent[pair] = pairs.tangent_impulse[pair];
      pairs.mark[pair] = 0;
    });
  };
  load_pairs(list.bodies, scratch.bodies, range.first_body_pair, range.last_body_pair);
  load_pairs(list.circles, scratch.circles, range.first_circle_pair, range.last_circle_pair);
  load_pairs(list.walls, scratch.walls, range.first_wall_pair, range.last_wall_pair);
}

/// Writes the result of a successful try back to the body in `slot`, if there is one.
HEDON_FN void commit_body(const PhysicsState& state, const PhysicsScratch& scratch, int32_t slot) {
  const BodyState& bodies = state.bodies;
  const int32_t index = state.neighbors.index[slot];
  if (index < 0) return;
  bodies.x[slot] = scratch.position[index].x;
  bodies.y[slot] = scratch.position[index].y;
  bodies.angle[slot] = wrap_angle(scratch.angle[index]);
  bodies.velocity_x[slot] = scratch.motion[index].x;
  bodies.velocity_y[slot] = scratch.motion[index].y;
  bodies.angular_velocity[slot] = scratch.motion[index].angular;
}

/// Writes back the impulses of a batch's pairs.
template <class Crew>
HEDON_FN void commit_pairs(const Crew& crew, const PhysicsState& state, const PhysicsScratch& scratch,
                           const BatchRange& range) {
  const NeighborList& list = state.neighbors;
  const auto store_pairs = [&](const PairList& pairs, const PairScratch& work, int32_t first, int32_t last) {
    crew.each(first, last, [&](int32_t pair) {
      pairs.normal_impulse[pair] = work.normal[pair];
      pairs.tangent_impulse[pair] = work.tangent[pair];
    });
  };
  store_pairs(list.bodies, scratch.bodies, range.first_body_pair, range.last_body_pair);
  store_pairs(list.circles, scratch.circles, range.first_circle_pair, range.last_circle_pair);
  store_pairs(list.walls, scratch.walls, range.first_wall_pair, range.last_wall_pair);
}

/// Lists in a row that only motion made stale, after which a list is made to last for two steps.
inline constexpr int32_t UNCHANGED_LISTS = 4;

/// Skins for new lists, in paths of the fastest body in a step: of lists that last for one step, even if bodies become
/// faster by a fifth (`SKIN_SHARE`), and of lists that last for two. The latter are worth their additional pairs if
/// changes are rare, since each change makes a list stale.
inline constexpr float ONE_STEP_SKIN = 2.5f, TWO_STEP_SKIN = 4.5f;

/// Whether a list with another skin would probably fill no more than half of its room. The area in which a body has
/// neighbors grows by less than the square of the skin's growth.
HEDON_FN bool fits(const NeighborList& list, float skin) {
  const NeighborHead& head = list.head[0];
  const float growth = skin > head.skin ? skin / head.skin : 1.0f;
  const auto enough = [&](const PairList& pairs) {
    const float expected = growth * growth * static_cast<float>(pairs.start[head.bodies]);
    return expected <= 0.5f * static_cast<float>(pairs.first.count);
  };
  return enough(list.bodies) && enough(list.circles) && enough(list.walls);
}

/// Largest squared distance of a batch's bodies from their positions at the last build; infinite if one is not finite.
template <class Bodies, class Crew>
HEDON_FN float squared_moved(const Batch<Bodies, Crew>& batch) {
  const NeighborList& list = batch.state.neighbors;
  float largest = 0.0f;
  batch.each_body([&](int32_t index) {
    const Vec2 moved = batch.scratch.position[index] - Vec2{list.build_x[index], list.build_y[index]};
    const float squared = squared_length(moved);
    if (!(squared <= largest)) largest = squared == squared ? squared : std::numeric_limits<float>::infinity();
  });
  return batch.crew.largest(largest);
}

/// Tries all substeps of one batch in the scratch memory. Stops early if a body moved too far for the skin.
template <class Solver, class Bodies, class Crew, class Visitor>
HEDON_CLONED HEDON_FN void try_batch(const Crew& crew, const PhysicsConfig& config, const BodyTable& table,
                                     const SolverConstants& c, const PhysicsState& state, const PhysicsScratch& scratch,
                                     const BodyForce& force, float squared_limit, int32_t number, Visitor& visitor) {
  const Bodies bodies(table, state, scratch);
  const BatchRange range = batch_range(state.neighbors, number);
  const Batch<Bodies, Crew> batch{crew, config, bodies, table, c, state, scratch, range};
  BatchReport report{};
  load_batch(batch, force, report, visitor);
  for (int32_t substep = 0; substep < config.substeps; ++substep) {
    Solver::substep(batch, visitor);
    const float moved = squared_moved(batch);
    if (moved > report.squared_moved) report.squared_moved = moved;
    if (report.squared_moved > squared_limit) break;
  }
  const Motion* motion = scratch.motion.data;
  batch.each_body([&](int32_t index) {
    const float squared = motion[index].x * motion[index].x + motion[index].y * motion[index].y;
    if (squared > report.squared_speed) report.squared_speed = squared;
  });
  report.squared_speed = crew.largest(report.squared_speed);
  report.squared_force = crew.largest(report.squared_force);
  crew.once([&] { scratch.reports[number] = report; });
}

/// The maxima over all batches.
HEDON_FN BatchReport largest_report(const PhysicsScratch& scratch, int32_t batches) {
  BatchReport all{};
  for (int32_t batch = 0; batch < batches; ++batch) {
    const BatchReport& one = scratch.reports[batch];
    if (one.squared_moved > all.squared_moved) all.squared_moved = one.squared_moved;
    if (one.squared_speed > all.squared_speed) all.squared_speed = one.squared_speed;
    if (one.squared_force > all.squared_force) all.squared_force = one.squared_force;
  }
  return all;
}

/// Maximum number of doublings of the skin within a step; after that, the step fails. A jam under the solver jacobi
/// once threw a body 330 u in a step, more than 8 doublings cover; 12 cover 4,000 u with the usual skin.
inline constexpr int MAX_REPEATS = 12;

/// One step of the physics. All members of the group call it with the same arguments.
///
/// order    slots of the `count` living bodies. Everything is done in this order, so that results do not depend on
///          which slots are used. The caller calls `mark_stale` after a change of the order, of circles, walls or
///          positions.
/// force    acts in the first substep
/// fault    neighbor_overflow; not_finite; contact_outside_skin if even a skin 2^12 times as wide is not enough.
///          The bodies are then as they were before the step.
///
/// A step is tried in scratch memory. If a body moves further than the neighbor list allows, the list is built with
/// twice the skin and the step is tried again, so that no contact is ever missed.
///
/// Returns whether there was no fault. Use this result: afterwards any member may set a fault, so none may read it.
template <class Group, class Visitor>
HEDON_FN bool physics_step(Group& group, const PhysicsConfig& config, const BodyTable& table, const PhysicsState& state,
                           const PhysicsScratch& scratch, const Array<int32_t>& order, int32_t count,
                           const BodyForce& force, Visitor& visitor, Fault& fault) {
  NeighborHead& head = state.neighbors.head[0];
  const SolverConstants constants = make_constants(config);
  bool build = head.stale != 0;
  const float spare = (head.moved == UNCHANGED_LISTS ? TWO_STEP_SKIN : ONE_STEP_SKIN) * head.free_path;
  const float usual_skin = config.neighbor_skin > spare ? config.neighbor_skin : spare;
  float skin = usual_skin;
  BatchReport report{};
  const PhysicsScratch* work = &scratch;
  int repeat = 0;
  for (;; ++repeat) {
    if (build) {
      group.together(
          [&](const auto& crew) { build_neighbors(crew, state, table, scratch, order.data, count, skin, fault); });
      if (fault.status != Status::ok) return false;
    }
    work = &group.stage(scratch, state.neighbors);
    skin = head.skin;
    const float limit = SKIN_SHARE * skin;
    group.for_each_by_crew(head.batches, [&](const auto& crew, int32_t batch) {
      const auto attempt = [&]<class Solver, class Bodies>() {
        try_batch<Solver, Bodies>(crew, config, table, constants, state, *work, force, limit * limit, batch, visitor);
      };
      const bool sequential = config.solver == PhysicsSolver::sequential;
      const bool alike = table.classes == 1 && table.own == 0;
      if (alike)
        sequential ? attempt.template operator()<SequentialSolver, AlikeBodies>()
                   : attempt.template operator()<JacobiSolver, AlikeBodies>();
      else
        sequential ? attempt.template operator()<SequentialSolver, MixedBodies>()
                   : attempt.template operator()<JacobiSolver, MixedBodies>();
    });
    report = largest_report(scratch, head.batches);
    if (report.squared_moved <= limit * limit) break;
    const bool finite = report.squared_moved < std::numeric_limits<float>::infinity();
    if (!finite || repeat == MAX_REPEATS) {
      group.once([&] {
        raise_fault(fault, finite ? Status::contact_outside_skin : Status::not_finite, report.squared_moved);
        head.stale = 1;
      });
      return false;
    }
    group.barrier();  // all members have read the reports, so a new list may be built
    // If the list was new, its skin was too small. If it was an older one, the same skin may be enough for a new list.
    skin = build ? 2.0f * skin : usual_skin;
    build = true;
  }
  // The distance that the fastest body can move in a step without contacts, with the largest push of this step. Both
  // solvers limit the speeds of a step before its bodies move.
  const float capped = 2.0f * constants.max_speed * constants.max_speed;
  const float squared_speed = report.squared_speed < capped ? report.squared_speed : capped;
  const float inverse_mass = 1.0f / table.min_mass();
  const float speed = sqrtf(squared_speed) + sqrtf(report.squared_force) * inverse_mass * constants.dt;
  const float free_path = speed * constants.glide;
  const int32_t stale = sqrtf(report.squared_moved) + free_path > SKIN_SHARE * skin;
  // Bodies by slot, not by batch; otherwise two members would alternately write to most cache lines.
  group.for_each(static_cast<int>(state.neighbors.index.count), [&](int32_t slot) { commit_body(state, *work, slot); });
  group.for_each_by_crew(head.batches, [&](const auto& crew, int32_t batch) {
    commit_pairs(crew, state, *work, batch_range(state.neighbors, batch));
    if (batch > 0) return;
    crew.once([&] {
      head.stale = stale;
      if (!fits(state.neighbors, TWO_STEP_SKIN * free_path))
        head.moved = 0;
      else if (head.moved < UNCHANGED_LISTS)
        head.moved += stale;
      head.free_path = free_path;
      head.repeats += repeat;
    });
  });
  return true;
}

}  // namespace hedon
