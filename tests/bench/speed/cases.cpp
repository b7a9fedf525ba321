#include "tests/bench/speed/cases.h"

#include <cstddef>

#include "server/cli/common/scene_argument.h"
#include "tests/bench/speed/scenes.h"

namespace vat::bench {

namespace {

struct Size {
  const char* name;
  int lattice;  ///< of the generator
  bool is_long;
};

/// A pile of many bodies.
struct Pile {
  const char* name;  ///< number of particles
  std::uint32_t bodies;
  Real spacing;  ///< of particles [m]
};

void add_dam_breaks(std::vector<SpeedCase>& cases) {
  constexpr Size kSizes[] = {{"1k", 8, false},
                             {"10k", 17, false},
                             {"30k", 25, true},
                             {"100k", 37, true},
                             {"300k", 53, true}};
  for (const PressureSolver solver : {PressureSolver::tait, PressureSolver::incompressible}) {
    for (const Size& size : kSizes) {
      cases.push_back({"dam-break-" + std::string(size.name) + '-' + to_string(solver),
                       [=] { return dam_break(size.lattice, solver); },
                       {.warm_up = 0.3, .measured = 0.1},
                       size.is_long});
    }
  }
}

void add_peer_dam_breaks(std::vector<SpeedCase>& cases) {
  constexpr Size kSizes[] = {{"10k", 22, false}, {"30k", 31, true}, {"97k", 46, true}};
  for (const PressureSolver solver : {PressureSolver::incompressible, PressureSolver::tait}) {
    for (const Size& size : kSizes) {
      cases.push_back({"peer-dam-break-" + std::string(size.name) + '-' + to_string(solver),
                       [=] { return peer_dam_break(size.lattice, solver); },
                       {.warm_up = 0, .measured = 1, .repetitions = 3},
                       size.is_long});
    }
  }
}

void add_rigid_piles(std::vector<SpeedCase>& cases) {
  for (const InterfaceLaw law : {InterfaceLaw::penalty, InterfaceLaw::projection}) {
    cases.push_back({"rigid-pile-200-" + std::string(to_string(law)),
                     [=] { return rigid_pile(200, law); },
                     {.warm_up = 0.6, .measured = 0.4}});
  }
  constexpr Pile kPiles[] = {{"30k", 1111, 0.04}, {"300k", 2600, 0.024}};
  for (const Pile& pile : kPiles) {
    cases.push_back({"rigid-pile-" + std::string(pile.name) + "-penalty",
                     [=] { return rigid_pile(pile.bodies, InterfaceLaw::penalty, pile.spacing); },
                     {.warm_up = 0.3, .measured = 0.05},
                     true});
  }
  cases.push_back({"rigid-rest-200",
                   [] { return rigid_pile(200, InterfaceLaw::projection); },
                   {.warm_up = 3, .measured = 0.1},
                   true});
}

/// A million particles: tests that they fit into memory and that a step runs.
Result<Scene> million() {
  Scene scene = peer_dam_break(100, PressureSolver::tait);
  scene.numerics.tick = scene.numerics.step;
  return scene;
}

}  // namespace

SpeedCase case_of_scene(const std::string& argument, const std::string& scenes_folder) {
  return {argument, [=] { return load_scene(argument, scenes_folder); }, {}};
}

std::vector<SpeedCase> all_speed_cases(const std::string& scenes_folder) {
  std::vector<SpeedCase> cases;
  add_dam_breaks(cases);
  add_peer_dam_breaks(cases);
  cases.push_back(case_of_scene("sliding-vat-solids", scenes_folder));
  cases.push_back(case_of_scene("sliding-vat-liquid", scenes_folder));
  add_rigid_piles(cases);
  cases.push_back(
      {"deformable-50", [] { return deformable_pile(50); }, {.warm_up = 0.6, .measured = 0.4}});
  constexpr Pile kPiles[] = {{"30k", 469, 0.04}, {"300k", 2400, 0.032}};
  for (const Pile& pile : kPiles) {
    cases.push_back({"deformable-" + std::string(pile.name),
                     [=] { return deformable_pile(pile.bodies, pile.spacing); },
                     {.warm_up = 0.3, .measured = 0.05},
                     true});
  }
  for (const PressureSolver solver : {PressureSolver::tait, PressureSolver::incompressible}) {
    cases.push_back({std::string("pool-10k-") + to_string(solver),
                     [=] { return pool(solver); },
                     {.warm_up = 3, .measured = 0.1},
                     true});
  }
  cases.push_back(
      {"million-tait", million, {.warm_up = 0, .measured = 0.002, .repetitions = 2}, true});
  return cases;
}

}  // namespace vat::bench
