#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>

#include "core/simulation.h"
#include "protocol/scene_json.h"

namespace {

int refuse(const std::vector<vat::Error>& errors) {
  for (const vat::Error& error : errors) std::cerr << error.path << ": " << error.message << '\n';
  return EXIT_FAILURE;
}

}  // namespace

// scene_hash SCENE.json SECONDS: prints the state's hash, as `vat simulate --hash` does. Built with
// other compiler options than the program, so that the two can be compared.
int main(int argc, char** argv) {
  if (argc != 3) return EXIT_FAILURE;
  const auto scene = vat::read_scene_file(argv[1]);
  if (!scene) return refuse(scene.errors());
  auto simulation = vat::Simulation::create(scene.value());
  if (!simulation) return refuse(simulation.errors());
  const double steps = std::round(std::strtod(argv[2], nullptr) / simulation.value().step_size());
  if (simulation.value().advance(static_cast<std::uint32_t>(steps)).failed) return EXIT_FAILURE;
  std::cout << std::hex << std::setw(16) << std::setfill('0') << simulation.value().state_hash()
            << '\n';
  return EXIT_SUCCESS;
}
