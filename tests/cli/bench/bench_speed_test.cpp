#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/bench/speed/cases.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/measure.h"
#include "tests/bench/speed/neighbours.h"
#include "tests/bench/speed/plots.h"
#include "tests/bench/speed/scenes.h"
#include "tests/bench/speed/skips.h"
#include "tests/bench/speed/targets.h"
#include "tests/cli/program.h"
#include "tests/support/memory/allocator.h"

namespace vat::bench::bench_speed_test {
namespace {

SpeedRow row(const std::string& name, std::size_t threads, std::size_t particles, Real seconds) {
  SpeedRow row;
  row.name = name;
  row.solver = name.ends_with("tait") ? "tait" : "incompressible";
  row.threads = threads;
  row.particles = particles;
  row.liquid_particles = particles;
  row.seconds = {0.5 * seconds, seconds, 3 * seconds};
  row.steps = 10;
  row.simulated = 0.1;
  row.flow = {.neighbours = 25, .density_error = 6e-4};
  row.bytes_per_particle = 300;
  return row;
}

std::string lines_with(const Table& table, const std::string& what) {
  std::string found;
  for (const std::string& line : test::lines_of(to_csv(table))) {
    if (line.find(what) != std::string::npos) found += line + '\n';
  }
  return found;
}

TEST(BenchSpeedFigures, TimesGoByTheMedian) {
  const SpeedRow one = row("dam-break-1k-tait", 1, 1000, 0.2);
  EXPECT_DOUBLE_EQ(one.median_ms_per_step(), 20);
  EXPECT_DOUBLE_EQ(one.least_ms_per_step(), 10);
  EXPECT_DOUBLE_EQ(one.wall_per_simulated(), 2);
  EXPECT_DOUBLE_EQ(one.real_time_factor(), 0.5);
  EXPECT_DOUBLE_EQ(one.particle_steps_per_second(), 1000 * 10 / 0.2);
}

// A cubic lattice of n^3 points has 6 n^2 (n - 1), 12 n (n - 1)^2 and 8 (n - 1)^3 ordered pairs at
// 1, sqrt 2 and sqrt 3 spacings. Pairs at exactly two spacings, the support radius, do not count.
// At half a spacing from a wall, the lattice continues in the mirror images.
TEST(BenchSpeedFigures, NeighboursOfALattice) {
  Scene scene = peer_dam_break(4, PressureSolver::tait);
  scene.vat->min = {-3, -2, -1};
  EXPECT_DOUBLE_EQ(mean_neighbours(Simulation::create(scene).value()),
                   (6 * 16 * 3 + 12 * 4 * 9 + 8 * 27) / 64.0);
  scene.vat = Vat{{-2, -0.5, 0}, {-1, 0.5, 1}, true, {}};
  EXPECT_DOUBLE_EQ(mean_neighbours(Simulation::create(scene).value()), 26);
  scene.vat->lid = false;
  EXPECT_DOUBLE_EQ(mean_neighbours(Simulation::create(scene).value()), 26 - 9 / 4.0);
  EXPECT_TRUE(std::isnan(
      mean_neighbours(Simulation::create(rigid_pile(1, InterfaceLaw::penalty)).value())));
}

#if VAT_HAS_SYSTEM_ALLOCATOR
// At least positions and velocities, plus the memory of diagnostics, without the snapshot. A second
// simulation of the same size gives the size of the snapshot.
TEST(BenchSpeedFigures, MemoryIsThatOfTheSimulation) {
  const Scene scene = dam_break(12, PressureSolver::tait);
  const SpeedSettings settings{.warm_up = 0, .measured = 0.02, .repetitions = 1};
  const auto rows = measure("x", scene, {{1}, InstructionSet::baseline}, settings).value();
  const std::size_t before = heap_in_use();
  Simulation simulation = Simulation::create(scene, nullptr, InstructionSet::baseline).value();
  simulation.advance(simulation.steps_per_tick());
  const auto bytes = static_cast<Real>(heap_in_use() - before) / (2 * 12 * 12 * 12);
  EXPECT_GT(bytes, 2 * sizeof(Vec3));
  EXPECT_NEAR(rows[0].bytes_per_particle, bytes, 0.05 * bytes);
  EXPECT_GE(rows[0].bytes_with_diagnostics, rows[0].bytes_per_particle);
}
#endif

// All sizes are one scene, and the peer's scene has the peer's numbers of particles.
TEST(BenchSpeedScenes, SizesAreThoseOfTheirNames) {
  for (const SpeedCase& one : all_speed_cases(VAT_SOURCE_DIR "/protocol/scenes")) {
    const Result<Scene> scene = one.make();
    ASSERT_TRUE(scene) << one.name;
    constexpr std::string_view kBefore = "dam-break-";
    const std::size_t size = one.name.find(kBefore);
    if (size == std::string::npos || one.is_long) continue;
    const Simulation simulation = Simulation::create(scene.value()).value();
    const Real named = 1000 * std::stod(one.name.substr(size + kBefore.size()));
    EXPECT_NEAR(static_cast<Real>(simulation.particle_count()) / named, 1, 0.1) << one.name;
  }
  EXPECT_EQ(Simulation::create(peer_dam_break(22, PressureSolver::incompressible))
                .value()
                .particle_count(),
            10'648u);
}

TEST(BenchSpeedTables, TargetsAreComparedWithMeasurements) {
  std::vector<SpeedRow> rows = {row("dam-break-10k-tait", 1, 10'000, 0.05),
                                row("dam-break-100k-tait", 1, 100'000, 0.8),
                                row("dam-break-30k-tait", 1, 30'000, 0.3),
                                row("dam-break-30k-tait", 4, 30'000, 0.1),
                                row("peer-dam-break-10k-incompressible", 1, 10'648, 0.19),
                                row("sliding-vat-solids", 1, 1026, 0.03)};
  rows[0].instructions = InstructionSet::avx2;
  using std::chrono_literals::operator""ms;
  rows[0].stages = {{"find_pairs", 10, 10ms},
                    {"liquid_density", 10, 5ms},
                    {"kick", 10, 9ms},
                    {"liquid_forces", 10, 10ms}};
  const Table table = target_table(targets_of(rows, {}));
  // 25 ms for 10 steps of 10 000 particles with 25 neighbours. The other values follow by ratios.
  EXPECT_THAT(lines_with(table, "ns per neighbour"),
              testing::HasSubstr("avx2\",at most 11,10,true"));
  EXPECT_THAT(lines_with(table, "100k-tait over"), testing::HasSubstr("at most 1.5,1.6,false"));
  EXPECT_THAT(lines_with(table, "speed-up"), testing::HasSubstr("at least 3.3,2.99"));
  EXPECT_THAT(lines_with(table, "speed-up"), testing::HasSubstr(",false"));
  EXPECT_THAT(lines_with(table, "wall s"), testing::HasSubstr("at most 2,1.9,true"));
  EXPECT_THAT(lines_with(table, "real-time"), testing::HasSubstr("at least 4,3.33"));
  EXPECT_THAT(lines_with(table, "density error"), testing::HasSubstr("6e-04,false"));
  EXPECT_THAT(lines_with(table, "bytes per particle, sliding"), testing::IsEmpty());
  EXPECT_THAT(lines_with(table, "bytes per particle, dam-break-30k"),
              testing::HasSubstr("at most 400,300,true"));
}

TEST(BenchSpeedTables, SkipsAreRatios) {
  SkipPair pair{.name = "s", .what = "w", .with = {}, .without = {}, .settings = {}, .most = 0.4};
  const SkipResult result{pair, {row("s-with", 1, 10, 1)}, {row("s-without", 1, 10, 2)}};
  EXPECT_EQ(lines_with(skip_table({result}), "s,w,"), "s,w,1,10,20,0.5,0.5\n");
  EXPECT_EQ(lines_with(target_table(targets_of({}, {result})), "with over"),
            "\"time with over without, s, 1 thread\",at most 0.4,0.5,false\n");
}

TEST(BenchSpeedPlots, SizesAndThreads) {
  const std::vector<SpeedRow> rows = {
      row("dam-break-1k-tait", 1, 1000, 0.01), row("dam-break-1k-tait", 4, 1000, 0.005),
      row("dam-break-10k-tait", 1, 10'000, 0.2), row("dam-break-10k-tait", 4, 10'000, 0.05),
      row("peer-dam-break-10k-tait", 1, 10'000, 0.2)};
  const LogPlot sizes = size_plot(rows);
  ASSERT_EQ(sizes.series.size(), 2u);
  EXPECT_EQ(sizes.series[0].label, "tait, 1 thread");
  ASSERT_EQ(sizes.series[0].points.size(), 2u);
  EXPECT_DOUBLE_EQ(sizes.series[0].points[1][0], 10'000);
  EXPECT_DOUBLE_EQ(sizes.series[0].points[1][1], 2000);  // 20 ms for 10 000 particles
  const LogPlot threads = thread_plot(rows);
  ASSERT_EQ(threads.series.size(), 2u);
  EXPECT_EQ(threads.series[1].label, "10k-tait");
  EXPECT_DOUBLE_EQ(threads.series[1].points[1][0], 4);
  EXPECT_DOUBLE_EQ(threads.series[1].points[1][1], 4);
}

// Both scenes of every pair run with all numbers of threads.
TEST(BenchSpeedSkips, PairsRun) {
  for (std::size_t i = 0; i < skip_names().size(); ++i) {
    SkipPair pair = make_skip_pair(i);
    pair.settings = {.warm_up = 0, .measured = 0.02, .repetitions = 1};
    const Result<SkipResult> result = measure_skip(pair, {{1, 2}, InstructionSet::baseline});
    ASSERT_TRUE(result) << pair.name << ' ' << result.errors().front().message;
    ASSERT_EQ(result.value().with.size(), 2u);
    ASSERT_EQ(result.value().without.size(), 2u);
    EXPECT_EQ(result.value().with[1].name, skip_names()[i] + "-with");
    EXPECT_EQ(result.value().without[1].name, skip_names()[i] + "-without");
    EXPECT_EQ(result.value().without[1].threads, 2u);
  }
}

}  // namespace
}  // namespace vat::bench::bench_speed_test
