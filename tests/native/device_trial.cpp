/// Trials of a CUDA device or its emulation, without Python; `tests/device.py` builds and runs this program.
///
///     device_trial describe                        describes the device
///     device_trial same STEPS WORLDS FILE          compares bits with the processor, after steps in two pieces
///     device_trial repeat STEPS WORLDS FILE        compares the first world with a repeat, and among WORLDS
///     device_trial resume STEPS FILE               goes from device to processor and back, by checkpoints
///     device_trial first STEPS FILE                finds the first step after which bits differ, and the arrays
///     device_trial time SECONDS WORLDS FILE [N]    times whole windows, N per call, for about SECONDS
///
/// Each prints one JSON object. Exit status 1 if bits differ or a world has a fault, 2 if the trial is impossible.
#include <chrono>
#include <cstring>

#include "base/float_mode.h"
#include "world_file.h"

namespace hedon {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int MAX_WINDOWS = 16;

double since(Clock::time_point begun) { return std::chrono::duration<double>(Clock::now() - begun).count(); }

/// Advances; ends the program if the device fails.
void advance(Simulation& simulation, int64_t steps) {
  simulation.run(steps);
  if (simulation.device_complaint().empty()) return;
  fprintf(stderr, "%s\n", simulation.device_complaint().c_str());
  exit(2);
}

std::unique_ptr<Simulation> on_device(const WorldInput& input, int64_t worlds) {
  auto simulation = make_worlds(input, worlds, true);
  advance(*simulation, 0);
  return simulation;
}

/// Whether a world has no fault and this digest.
bool sound(Simulation& simulation, int index, uint64_t digest) {
  return simulation.numbers(index).fault().status == Status::ok && simulation.digest(index) == digest;
}

/// A fault as text; "" for none.
std::string fault_text(Simulation& simulation, int index) {
  const Fault& fault = simulation.numbers(index).fault();
  if (fault.status == Status::ok) return "";
  char text[200];
  snprintf(text, sizeof text, "%s at step %lld, agent %d, value %g", STATUS_TEXT[static_cast<int>(fault.status)].name,
           static_cast<long long>(fault.step), fault.agent_id, fault.value);
  return text;
}

/// Bytes as hexadecimal digits, last byte first, as in a number.
std::string hex(const char* bytes, size_t count) {
  constexpr size_t MOST = 8;
  std::string text;
  for (size_t i = std::min(count, MOST); i-- > 0;) {
    char digits[3];
    snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(static_cast<unsigned char>(bytes[i])));
    text += digits;
  }
  return text;
}

/// Arrays of the state that differ, each with its first item that does. Some are not valid in unused slots.
std::string differing_arrays(const WorldState& here, const WorldState& there) {
  std::vector<std::pair<const char*, size_t>> arrays;
  for_each_array(here, "", [&]<class T>(const std::string&, const Array<T>& array) {
    arrays.emplace_back(reinterpret_cast<const char*>(array.data), static_cast<size_t>(array.count) * sizeof(T));
  });
  std::string text;
  size_t next = 0;
  for_each_array(there, "", [&]<class T>(const std::string& name, const Array<T>& array) {
    const auto [expected, bytes] = arrays[next++];
    const char* const found = reinterpret_cast<const char*>(array.data);
    size_t at = 0, differ = 0;
    for (size_t i = bytes; i-- > 0;) {
      if (expected[i] == found[i]) continue;
      at = i;
      ++differ;
    }
    if (differ == 0) return;
    const size_t item = at / sizeof(T) * sizeof(T);
    text += (text.empty() ? "" : ", ") + name + "[" + std::to_string(at / sizeof(T)) + "] " +
            hex(expected + item, sizeof(T)) + " " + hex(found + item, sizeof(T)) + ", " + std::to_string(differ) +
            " of " + std::to_string(bytes) + " bytes";
  });
  return text;
}

/// Runs the same world on both backends and compares every few steps; if bits differ, runs again from the last equal
/// state and compares after every step.
int report_first(int64_t steps, const WorldInput& input) {
  constexpr int64_t FEW = 16;
  int64_t from = 0;
  for (int64_t stride = FEW;; stride = 1) {
    const auto here = make_worlds(input, 1, false), there = on_device(input, 1);
    here->run(from);
    advance(*there, from);
    int64_t step = from;
    while (step < steps && sound(*there, 0, here->digest(0))) {
      here->run(stride);
      advance(*there, stride);
      step += stride;
    }
    if (sound(*there, 0, here->digest(0))) break;
    if (stride > 1 && step > 0) {
      from = step - stride;
      continue;
    }
    const std::string differ = differing_arrays(here->complete(0).state, there->complete(0).state);
    printf("{\"first_step\": %lld, \"alive\": [%d, %d], \"fault\": \"%s\", \"differ\": \"%s\"}\n",
           static_cast<long long>(step), here->numbers(0).head().living_count, there->numbers(0).head().living_count,
           fault_text(*there, 0).c_str(), differ.c_str());
    return 1;
  }
  printf("{\"steps\": %lld, \"equal\": true}\n", static_cast<long long>(steps));
  return 0;
}

int report_same(int64_t steps, int64_t worlds, const WorldInput& input) {
  const auto here = make_worlds(input, worlds, false), there = on_device(input, worlds);
  Clock::time_point begun = Clock::now();
  here->run(steps);
  const double processor = since(begun);
  begun = Clock::now();
  advance(*there, steps / 3);
  advance(*there, steps - steps / 3);
  const double device = since(begun);
  int equal = 0;
  for (int i = 0; i < worlds; ++i) equal += sound(*there, i, here->digest(i));
  printf(
      "{\"worlds\": %lld, \"steps\": %lld, \"equal\": %d, \"alive\": %d, \"fault\": \"%s\", "
      "\"device_seconds\": %.3f, \"processor_seconds\": %.3f}\n",
      static_cast<long long>(worlds), static_cast<long long>(steps), equal, there->numbers(0).head().living_count,
      fault_text(*there, 0).c_str(), device, processor);
  return equal == worlds ? 0 : 1;
}

int report_repeat(int64_t steps, int64_t worlds, const WorldInput& input) {
  const auto one = on_device(input, 1), again = on_device(input, 1), many = on_device(input, worlds);
  for (Simulation* simulation : {one.get(), again.get(), many.get()}) advance(*simulation, steps);
  const uint64_t digest = one->digest(0);
  const bool repeated = sound(*again, 0, digest), among = sound(*many, 0, digest);
  printf("{\"steps\": %lld, \"repeated\": %s, \"among_%lld\": %s}\n", static_cast<long long>(steps),
         repeated ? "true" : "false", static_cast<long long>(worlds), among ? "true" : "false");
  return repeated && among ? 0 : 1;
}

/// Three thirds, on the device, the processor and the device, compared with a run on the processor only.
int report_resume(int64_t steps, const WorldInput& input) {
  const auto whole = make_worlds(input, 1, false);
  whole->run(3 * steps);
  Checkpoint checkpoint;
  std::string wrong;
  std::unique_ptr<Simulation> last;
  for (const bool device : {true, false, true}) {
    last = make_worlds(input, 1, device);
    if (!checkpoint.empty()) wrong += last->restore(0, checkpoint);
    advance(*last, steps);
    checkpoint = last->save(0);
  }
  const bool equal = wrong.empty() && sound(*last, 0, whole->digest(0));
  printf("{\"steps\": %lld, \"equal\": %s, \"complaint\": \"%s\"}\n", static_cast<long long>(3 * steps),
         equal ? "true" : "false", wrong.c_str());
  return equal ? 0 : 1;
}

int report_time(double seconds, int64_t worlds, const WorldInput& input, int windows_per_call) {
  Clock::time_point begun = Clock::now();
  const auto simulation = on_device(input, worlds);
  const double made = since(begun);
  const int64_t window = simulation->shape().steps;
  advance(*simulation, window);
  const DeviceSeconds before = simulation->device_seconds();
  begun = Clock::now();
  int windows = 0;
  int64_t alive = 0;
  while (windows < MAX_WINDOWS && (windows == 0 || since(begun) < seconds)) {
    advance(*simulation, window * windows_per_call);
    windows += windows_per_call;
    for (int i = 0; i < worlds; ++i) alive += int64_t{simulation->numbers(i).head().living_count} * windows_per_call;
  }
  const double taken = since(begun);
  const DeviceSeconds after = simulation->device_seconds();
  begun = Clock::now();
  simulation->complete(0);
  const double fetched = since(begun);
  const double steps = static_cast<double>(windows * worlds * window);
  printf("{\"worlds\": %lld, \"windows\": %d, \"alive\": %.1f, \"seconds\": %.4f, \"world_steps_per_second\": %.0f",
         static_cast<long long>(worlds), windows, static_cast<double>(alive) / static_cast<double>(windows * worlds),
         taken, steps / taken);
  for (int32_t part = 0; part < DEVICE_PARTS; ++part)
    printf(", \"%s_seconds\": %.4f", DEVICE_PART_NAMES[part], after.kernel[part] - before.kernel[part]);
  printf(
      ", \"copying_seconds\": %.4f, \"making_seconds\": %.3f, \"fetch_one_world_seconds\": %.4f, "
      "\"bytes_per_world\": %lld}\n",
      after.copying - before.copying, made, fetched, static_cast<long long>(simulation->bytes_per_world()));
  for (int i = 0; i < worlds; ++i) {
    if (simulation->numbers(i).fault().status != Status::ok) return 1;
  }
  return 0;
}

int report(const std::string& what, const std::vector<std::string>& given) {
  const DeviceProgram& program = *hedon_device();
  const std::string problem = program.open();
  if (!problem.empty()) {
    fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
  if (what == "describe" && given.empty()) {
    program.use(0);
    printf("%s\n", program.describe());
    return 0;
  }
  const bool windows_given = what == "time" && given.size() == 4;
  const bool three = given.size() == 3 || windows_given;
  if (!three && !((what == "resume" || what == "first") && given.size() == 2)) {
    fprintf(stderr,
            "device_trial describe | same|repeat STEPS WORLDS FILE | resume|first STEPS FILE | "
            "time SECONDS WORLDS FILE [WINDOWS PER CALL]\n");
    return 2;
  }
  const int64_t worlds = three ? atoll(given[1].c_str()) : 1;
  const WorldInput input = read_world(given[three ? 2 : 1], worlds);
  if (what == "same") return report_same(atoll(given[0].c_str()), worlds, input);
  if (what == "repeat") return report_repeat(atoll(given[0].c_str()), worlds, input);
  if (what == "first") return report_first(atoll(given[0].c_str()), input);
  if (what == "resume") return report_resume(atoll(given[0].c_str()), input);
  const int windows_per_call = windows_given ? std::max(1, atoi(given[3].c_str())) : 1;
  return report_time(atof(given[0].c_str()), worlds, input, windows_per_call);
}

}  // namespace
}  // namespace hedon

int main(int count, char** arguments) {
  const hedon::FloatMode mode;
  return hedon::report(count > 1 ? arguments[1] : "",
                       std::vector<std::string>(arguments + std::min(count, 2), arguments + count));
}
