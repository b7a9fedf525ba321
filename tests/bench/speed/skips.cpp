#include "tests/bench/speed/skips.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "tests/bench/speed/scenes.h"

namespace vat::bench {

namespace {

/// Bodies without liquid, and with one liquid particle.
SkipPair skip_liquid() {
  SkipPair pair{.what = "all stages of liquids, where there is none (without: one particle)",
                .with = rigid_pile(200, InterfaceLaw::penalty),
                .without = {},
                .settings = {.warm_up = 0.6, .measured = 0.2}};
  pair.without = pair.with;
  Material& water = pair.without.materials.emplace_back();
  water.name = "water";
  water.liquid = LiquidConstants{.stiffness = 400, .viscosity = 0.1, .support_radius = 0.08};
  BodyDescription drop;
  drop.name = "drop";
  drop.kind = BodyKind::liquid;
  drop.material = "water";
  drop.spacing = 0.04;
  drop.shape = BoxShape{Vec3::Zero(), {0.04, 0.04, 0.04}};
  drop.position = {0.04, 0.04, 2.9};
  pair.without.bodies.push_back(std::move(drop));
  return pair;
}

/// One stiff block among soft blocks.
SkipPair skip_short_steps() {
  constexpr Real kStiffness = 64;  // relative to the others: an eighth of the step
  SkipPair pair{.what = "short steps of what does not need them (without: all take them)",
                .with = deformable_pile(50),
                .without = {},
                .settings = {.warm_up = 0.4, .measured = 0.1}};
  Material stiff = pair.with.materials.front();
  stiff.name = "stiff jelly";
  for (auto* spring : {&stiff.springs->structural, &stiff.springs->shear, &stiff.springs->bend}) {
    (*spring)->stiffness *= kStiffness;
  }
  pair.with.materials.push_back(std::move(stiff));
  pair.with.bodies.back().material = "stiff jelly";
  pair.without = pair.with;
  pair.with.numerics.control = StepControl::local;
  pair.without.numerics.step /= 8;
  return pair;
}

/// Steps that resolve the liquid's viscosity, and steps that are a tenth longer and do not.
SkipPair skip_viscosity_solve() {
  SkipPair pair{.what =
                    "the solve for viscosity, where steps resolve it (without: 1.1 times the "
                    "step)",
                .with = dam_break(17, PressureSolver::tait),
                .without = {},
                .settings = {.warm_up = 0.3, .measured = 0.1}};
  pair.without = pair.with;
  Numerics& numerics = pair.without.numerics;
  numerics.step *= 1.1;
  numerics.tick *= 1.1;
  return pair;
}

/// A scene whose bodies sleep when the timing starts.
SkipPair skip_rest(std::string what, Scene scene, Real warm_up, Real most) {
  SkipPair pair{.what = std::move(what),
                .with = scene,
                .without = std::move(scene),
                .settings = {.warm_up = warm_up, .measured = 0.1},
                .most = most};
  pair.with.sleeping = Sleeping{};
  return pair;
}

SkipPair skip_resting_liquid() {
  return skip_rest("10 000 particles of liquid at rest (without: all are stepped)",
                   pool(PressureSolver::tait), 3, 1.0 / 20);
}

SkipPair skip_resting_solids() {
  return skip_rest("200 rigid bodies at rest (without: all are stepped)",
                   rigid_pile(200, InterfaceLaw::projection), 4, 1.0 / 50);
}

/// The cost of sleep detection if no body sleeps.
SkipPair skip_nothing() {
  SkipPair pair{.what = "nothing, for nothing rests (without: nothing is looked at)",
                .with = dam_break(17, PressureSolver::tait),
                .without = {},
                .settings = {.warm_up = 0.3, .measured = 0.1},
                .most = 1.02};
  pair.without = pair.with;
  pair.with.sleeping = Sleeping{};
  return pair;
}

struct Skip {
  const char* name;
  SkipPair (*make)();
};

constexpr Skip kSkips[] = {{"skip-liquid-stages", skip_liquid},
                           {"skip-short-steps", skip_short_steps},
                           {"skip-viscosity-solve", skip_viscosity_solve},
                           {"skip-resting-liquid", skip_resting_liquid},
                           {"skip-resting-solids", skip_resting_solids},
                           {"skip-nothing-at-rest", skip_nothing}};

}  // namespace

std::vector<std::string> skip_names() {
  std::vector<std::string> names;
  for (const Skip& skip : kSkips) names.emplace_back(skip.name);
  return names;
}

SkipPair make_skip_pair(std::size_t index) {
  const Skip& skip = kSkips[index];
  SkipPair pair = skip.make();
  pair.name = skip.name;
  return pair;
}

Result<SkipResult> measure_skip(SkipPair pair, const SpeedSetup& setup) {
  Result<std::vector<SpeedRow>> rows =
      measure_in_turn({{pair.name + "-with", pair.with}, {pair.name + "-without", pair.without}},
                      setup, pair.settings);
  if (!rows) return rows.errors();
  const auto middle = rows.value().begin() + static_cast<std::ptrdiff_t>(rows.value().size() / 2);
  SkipResult result{std::move(pair), {}, {}};
  std::move(rows.value().begin(), middle, std::back_inserter(result.with));
  std::move(middle, rows.value().end(), std::back_inserter(result.without));
  return result;
}

Table skip_table(const std::vector<SkipResult>& results) {
  Table table{{"skip", "what is left out", "threads", "with [s/s]", "without [s/s]",
               "with / without", "least with / least without"},
              {}};
  for (const SkipResult& result : results) {
    for (std::size_t n = 0; n < result.with.size(); ++n) {
      const SpeedRow& with = result.with[n];
      const SpeedRow& without = result.without[n];
      const Real least =
          with.seconds.front() / with.simulated / (without.seconds.front() / without.simulated);
      table.rows.push_back({result.pair.name, result.pair.what, std::uint64_t{with.threads},
                            with.wall_per_simulated(), without.wall_per_simulated(),
                            with.wall_per_simulated() / without.wall_per_simulated(), least});
    }
  }
  return table;
}

}  // namespace vat::bench
