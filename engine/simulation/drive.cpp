/// The caller's part in worlds: rules, actions, and the observations and rewards that it reads.
#include <atomic>
#include <cstring>
#include <limits>

#include "base/float_mode.h"
#include "base/math.h"
#include "simulation/simulation.h"

namespace hedon {
namespace {

/// The range of an action.
struct ActionBounds {
  float low, high;
};

ActionBounds action_bounds(const SpeciesLayout& layout, ActionForm form) {
  constexpr float LARGEST = std::numeric_limits<float>::max();
  if (form == ActionForm::unit) return {-1.0f, 1.0f};
  if (form == ActionForm::force) return {layout.min_force, layout.max_force};
  return {-LARGEST, LARGEST};
}

/// The logit of an action's position between `low` and `high`.
float logit(float action, ActionBounds bounds) {
  constexpr float END = 80.0f;  // from here on the sigmoid is 1 in float32; at -80 it is 2e-35, which no force reflects
  const double way = static_cast<double>(action) - static_cast<double>(bounds.low);
  const double rest = static_cast<double>(bounds.high) - static_cast<double>(action);
  if (way <= 0.0) return -END;
  return rest <= 0.0 ? END : static_cast<float>(log_double(way) - log_double(rest));
}

/// Slots that a thread takes at a time.
constexpr int32_t SLOTS_AT_ONCE = 16;

/// Writes the reward of the agent in `slot` and the id of the present one to the row of the caller's arrays. Returns
/// whether the slot now has another agent, or none.
bool read_reward(const World& world, int32_t slot, const ObservationOut& out, int64_t row) {
  int32_t& id = out.agent_id[row];
  const int32_t before = id;
  out.reward[row] = id >= 0 ? world.state.reward[slot * int64_t{world.shape->rollout}] : 0.0f;
  id = world.state.alive[slot] != 0 ? world.state.life[slot].agent_id : -1;
  return id != before;
}

/// Writes the observation, reward and id for `slot` to the row of the caller's arrays; returns the result of
/// `read_reward`.
bool read_observation(World& world, int32_t slot, int rank, const ObservationOut& out, int64_t row) {
  const ObservationShape& shape = world.species(slot).network.observation;
  float* const observation = out.observation + row * shape.size();
  const bool acted = out.agent_id[row] >= 0;
  const bool changed = read_reward(world, slot, out, row);
  if (out.agent_id[row] < 0) {
    if (acted) memset(observation, 0, static_cast<size_t>(shape.size()) * sizeof(float));
    return changed;
  }
  ObservationLine lines[WIDE_LINES];
  PackedObservation& seen = *reinterpret_cast<PackedObservation*>(lines);
  note_start(world, slot);
  observe(world, slot, rank, seen);
  unpack(shape, seen, observation);
  return changed;
}

/// Visits both actions of every living agent of a species: its world, and the index of the action in the state and in
/// an array (worlds, slots of the species, 2).
template <class Worlds, class Visit>
void for_each_action(Worlds& worlds, const Species& own, Visit&& visit) {
  int64_t at = 0;
  for (auto& world : worlds) {
    for (int32_t slot = own.first_slot; slot < own.last_slot; ++slot, at += ACTIONS) {
      for (int64_t a = 0; a < ACTIONS && world.state.alive[slot] != 0; ++a)
        visit(world, slot * int64_t{ACTIONS} + a, at + a);
    }
  }
}

}  // namespace

void Simulation::set_rule(int32_t species, RuleUse use, Rule rule) {
  for (World& world : worlds_) world.rule[species][static_cast<int32_t>(use)] = rule;
}

std::string Simulation::missing_rule() const {
  for (int32_t s = 0; s < shape_.species; ++s) {
    for (int32_t u = 0; u < RULE_USES; ++u) {
      if (config_.layout[s].has_rule(static_cast<RuleUse>(u)) && worlds_[0].rule[s][u] == nullptr)
        return "species " + std::to_string(s) + " has a rule for its " + EnumNames<RuleUse>::text[u] +
               ", which was not given";
    }
  }
  return "";
}

int64_t Simulation::wrong_action(int32_t species, const float* actions, ActionForm form) const {
  const ActionBounds bounds = action_bounds(shape_.of[species].layout, form);
  int64_t bad = -1;
  for_each_action(worlds_, shape_.of[species], [&](const World&, int64_t, int64_t at) {
    if (bad < 0 && !(actions[at] >= bounds.low && actions[at] <= bounds.high)) bad = at;
  });
  return bad;
}

int64_t Simulation::set_actions(int32_t species, const float* actions, ActionForm form) {
  if (const int64_t bad = wrong_action(species, actions, form); bad >= 0) return bad;
  const ActionBounds bounds = action_bounds(shape_.of[species].layout, form);
  for_each_action(worlds_, shape_.of[species], [&](World& world, int64_t row, int64_t at) {
    world.state.external_action[row] = form == ActionForm::logit ? actions[at] : logit(actions[at], bounds);
  });
  return -1;
}

void Simulation::read_rewards(int32_t species, const ObservationOut& out) {
  const Species& own = shape_.of[species];
  for (int i = 0; i < world_count(); ++i) {
    const World& world = complete(i);
    const int64_t before = int64_t{i} * own.capacity() - own.first_slot;
    for (int32_t slot = own.first_slot; slot < own.last_slot; ++slot) read_reward(world, slot, out, before + slot);
  }
}

void Simulation::count_meals(int32_t species, int64_t* out) const {
  for (const World& world : worlds_) {
    for (int32_t meal = 0; meal < shape_.meals(); ++meal) {
      const bool mixed = world.state.eaten_by.count > 0;
      *out++ = mixed ? world.state.eaten_by[int64_t{species} * shape_.meals() + meal]
                     : (meal < shape_.kinds ? world.state.food_stock[meal].eaten : 0);
    }
  }
}

int64_t Simulation::read_observations(int32_t species, const ObservationOut& out) {
  const FloatMode mode(flush_);
  const Species& own = shape_.of[species];
  const int32_t blocks = (own.capacity() + SLOTS_AT_ONCE - 1) / SLOTS_AT_ONCE;
  for (World& world : worlds_) gather_scene(Alone{}, world);
  std::atomic<int32_t> next{0};
  std::atomic<int64_t> changed{0};
  pool_->run([&](int rank) {
    int64_t here = 0;
    for (int32_t i = next.fetch_add(1); i < world_count() * blocks; i = next.fetch_add(1)) {
      const int32_t first = own.first_slot + i % blocks * SLOTS_AT_ONCE;
      const int32_t last = first + SLOTS_AT_ONCE < own.last_slot ? first + SLOTS_AT_ONCE : own.last_slot;
      const int64_t before = int64_t{i / blocks} * own.capacity() - own.first_slot;
      for (int32_t slot = first; slot < last; ++slot)
        here += read_observation(world(i / blocks), slot, rank, out, before + slot) ? 1 : 0;
    }
    changed += here;
  });
  return changed;
}

}  // namespace hedon
