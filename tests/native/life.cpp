/// Simulates worlds from text files, without Python, on any machine, and prints the digest of each, one per line.
///
///     life kernels                                             the names of the kernels available here, best first
///     life KERNEL THREADS STEPS flush|keep FILE...             the best kernel if KERNEL is ""
///
/// All agents of an external species take the action of the golden cases (`tests/golden_case.py`).
#include <cstring>

#include "base/float_mode.h"
#include "world_file.h"

namespace hedon {
namespace {

constexpr float ACTION[2] = {0.8f, -0.3f};

void drive(Simulation& simulation) {
  const Config& config = simulation.config();
  for (int32_t s = 0; s < config.species.count; ++s) {
    if (config.species[s].learning.policy != LearningPolicy::external) continue;
    std::vector<float> actions;
    for (int32_t slot = 0; slot < config.species[s].population.capacity; ++slot)
      actions.insert(actions.end(), ACTION, ACTION + 2);
    simulation.set_actions(s, actions.data(), ActionForm::logit);
  }
}

/// Simulates a world and prints its digest; returns whether it has no fault.
bool live(const std::string& file, const Kernel* kernel, int threads, int64_t steps, bool flush) {
  const WorldInput input = read_world(file, 1);
  Simulation simulation(input.config, input.walls, static_cast<int32_t>(input.outer_walls), {input.seed}, threads,
                        kernel, {}, flush);
  drive(simulation);
  simulation.run(steps);
  printf("%016llx\n", static_cast<unsigned long long>(simulation.digest(0)));
  fflush(stdout);
  return simulation.numbers(0).fault().status == Status::ok;
}

int report(int count, char** arguments) {
  if (count == 2 && strcmp(arguments[1], "kernels") == 0) {
    for (const char* const* name = kernel_names(); *name != nullptr; ++name) puts(*name);
    return 0;
  }
  const Kernel* const kernel = count > 5 ? find_kernel(arguments[1]) : nullptr;
  if (kernel == nullptr) {
    fprintf(stderr, "life kernels | KERNEL THREADS STEPS flush|keep FILE...\n");
    return 2;
  }
  bool sound = true;
  for (int i = 5; i < count; ++i)
    sound &= live(arguments[i], kernel, atoi(arguments[2]), atoll(arguments[3]), strcmp(arguments[4], "flush") == 0);
  return sound ? 0 : 1;
}

}  // namespace
}  // namespace hedon

int main(int count, char** arguments) {
  const hedon::FloatMode mode;
  return hedon::report(count, arguments);
}
