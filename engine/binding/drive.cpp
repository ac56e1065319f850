#include "binding/drive.h"

#include <vector>

#include "binding/memory.h"

namespace nb = nanobind;

namespace hedon {
namespace {

/// Refuses an array of the caller that does not have one row for each slot of a species in each world.
template <class Table>
void need_rows(PythonSimulation& self, int32_t species, const Table& table) {
  const WorldShape& shape = self.get().shape();
  if (species < 0 || species >= shape.species) throw nb::index_error("no species has this index");
  if (self.get().config().species[species].learning.policy != LearningPolicy::external)
    throw nb::value_error("the species must be external");
  if (table.shape(0) != static_cast<size_t>(self.get().world_count()) ||
      table.shape(1) != static_cast<size_t>(shape.of[species].capacity()))
    throw nb::value_error("arrays must have a row for each slot of the species in each world");
}

/// The form of actions, if they are an array of the species. ValueError: they are not, or there is no such form.
ActionForm form_of(PythonSimulation& self, int32_t species, const TableIn& actions, const std::string& form) {
  need_rows(self, species, actions);
  if (actions.shape(2) != ACTIONS) throw nb::value_error("each agent has two actions");
  for (int32_t f = 0; f < 3; ++f) {
    if (form == ACTION_FORMS[f]) return static_cast<ActionForm>(f);
  }
  throw nb::value_error("actions are unit, force or logit");
}

}  // namespace

int64_t wrong_action(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form) {
  const ActionForm known = form_of(self, species, actions, form);
  return self.get().wrong_action(species, actions.data(), known);
}

int64_t set_actions(PythonSimulation& self, int32_t species, TableIn actions, const std::string& form) {
  const ActionForm known = form_of(self, species, actions, form);
  return self.get().set_actions(species, actions.data(), known);
}

int64_t read_observations(PythonSimulation& self, int32_t species, TableOut observation, RowsOut reward,
                          IdsOut agent_id) {
  need_rows(self, species, observation);
  need_rows(self, species, reward);
  need_rows(self, species, agent_id);
  const int32_t entries = self.get().shape().of[species].network.observation.size();
  if (observation.shape(2) != static_cast<size_t>(entries))
    throw nb::value_error("observations must have as many columns as there are entries");
  return self.read_observations(species, {observation.data(), reward.data(), agent_id.data()});
}

void read_rewards(PythonSimulation& self, int32_t species, RowsOut reward, IdsOut agent_id) {
  need_rows(self, species, reward);
  need_rows(self, species, agent_id);
  self.read_observations(species, {nullptr, reward.data(), agent_id.data()});
}

nb::object meals_of(PythonSimulation& self, int32_t species) {
  const Simulation& simulation = self.get();
  const WorldShape& shape = simulation.shape();
  if (species < 0 || species >= shape.species) throw nb::index_error("no species has this index");
  const size_t worlds = static_cast<size_t>(simulation.world_count()), meals = static_cast<size_t>(shape.meals());
  std::vector<int64_t> counts(worlds * meals);
  simulation.count_meals(species, counts.data());
  return nb::cast(to_numpy(counts.data(), {worlds, meals}));
}

}  // namespace hedon
