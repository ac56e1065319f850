/// Worlds from files in the format of `engine/web/input.h`, for programs without Python.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "simulation/config_check.h"
#include "simulation/simulation.h"
#include "web/input.h"

/// The device program of the linked library: CUDA's or the emulation's.
extern "C" const hedon::DeviceProgram* hedon_device();

namespace hedon {

inline constexpr int WORLD_THREADS = 4;  ///< on the processor: for two worlds, two teams of two

/// Reads a file; if it is invalid, exits with status 2 and a message.
inline WorldInput read_world(const std::string& file, int64_t worlds) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  WorldInput input;
  std::string wrong = read_input(text.str(), input);
  if (wrong.empty()) wrong = check_config(input.config);
  if (wrong.empty()) wrong = check_arguments(input.config, input.walls, input.outer_walls, worlds, WORLD_THREADS, {});
  if (wrong.empty()) return input;
  fprintf(stderr, "%s: %s\n", file.c_str(), wrong.c_str());
  exit(2);
}

/// Worlds with consecutive seeds, on the devices or, with AVX2, on the processor.
inline std::unique_ptr<Simulation> make_worlds(const WorldInput& input, int64_t worlds, bool on_device) {
  std::vector<uint64_t> seeds;
  for (int64_t i = 0; i < worlds; ++i) seeds.push_back(input.seed + static_cast<uint64_t>(i));
  return std::make_unique<Simulation>(input.config, input.walls, static_cast<int32_t>(input.outer_walls), seeds,
                                      WORLD_THREADS, find_kernel("avx2"), std::vector<int32_t>{}, true,
                                      on_device ? hedon_device() : nullptr);
}

}  // namespace hedon
