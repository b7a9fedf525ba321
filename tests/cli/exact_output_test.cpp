// Every number in the program's output has the same bits as in a simulation in this process.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "core/simulation/simulation.h"
#include "protocol/files/text.h"
#include "protocol/scene/scene_json.h"
#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test::exact_output_test {
namespace {

constexpr std::uint32_t kStepsPerOutput =
    30;  // differs from the tick's 20, so the program stops more often
constexpr std::size_t kOutputs = 5;

/// The simulation of the program: 0.12 s in four intervals of 0.03 s.
Simulation reference() {
  return Simulation::create(read_scene_file(test_scene("mixed")).value()).value();
}

void run_program(const TemporaryFolder& folder, const std::string& output) {
  const ProgramResult result =
      run_vat({"simulate", test_scene("mixed"), "--until", "0.12", "--every", "0.03", "--threads",
               "3", "--output", folder.file(output), "--diagnostics", folder.file("d.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

/// Calls `check(simulation, output)` at each output time.
template <class Check>
void at_each_output(Check check) {
  Simulation simulation = reference();
  check(simulation, std::size_t{0});
  for (std::size_t output = 1; output < kOutputs; ++output) {
    ASSERT_FALSE(simulation.advance(kStepsPerOutput).failed);
    check(simulation, output);
  }
}

/// Returns position and velocity, x to vz.
std::array<double, 6> motion_of(const BodyView& body, std::size_t i) {
  const Vec3& x = body.positions[i];
  const Vec3& v = body.velocities[i];
  return {x.x(), x.y(), x.z(), v.x(), v.y(), v.z()};
}

void expect_row(const Table& table, std::size_t row, const Simulation& simulation,
                const BodyView& body, std::size_t i) {
  ASSERT_EQ(table.number(row, "time"), simulation.time());
  ASSERT_EQ(table.text(row, "body"), body.name);
  ASSERT_EQ(table.text(row, "kind"), to_string(body.kind));
  ASSERT_EQ(table.number(row, "particle"), static_cast<double>(i));
  const std::array<double, 6> motion = motion_of(body, i);
  for (std::size_t c = 0; c < 6; ++c) ASSERT_EQ(parse_number(table.rows[row][4 + c]), motion[c]);
}

TEST(ExactOutput, Csv) {
  const TemporaryFolder folder;
  run_program(folder, "run.csv");
  const Table table = read_csv(folder.file("run.csv"));
  EXPECT_THAT(table.columns, testing::ElementsAre("time", "body", "kind", "particle", "x", "y", "z",
                                                  "vx", "vy", "vz", "density", "pressure"));
  std::size_t row = 0;
  at_each_output([&](const Simulation& simulation, std::size_t) {
    ASSERT_LE(row + simulation.particle_count(), table.rows.size());
    for (const BodyView& body : simulation.bodies()) {
      const bool liquid = body.kind == BodyKind::liquid;
      const LiquidFields fields =
          liquid ? simulation.liquid_fields(body.id).value() : LiquidFields{};
      for (std::size_t i = 0; i < body.positions.size(); ++i, ++row) {
        expect_row(table, row, simulation, body, i);
        if (liquid) {
          ASSERT_EQ(table.number(row, "density"), fields.density[i]);
          ASSERT_EQ(table.number(row, "pressure"), fields.pressure[i]);
        } else {
          ASSERT_EQ(table.text(row, "density") + table.text(row, "pressure"), "");
        }
      }
    }
  });
  EXPECT_EQ(row, table.rows.size());
}

TEST(ExactOutput, Npy) {
  const TemporaryFolder folder;
  run_program(folder, "run.npy");
  const Array array = read_npy(folder.file("run.npy"));
  std::size_t next = 0;
  at_each_output([&](const Simulation& simulation, std::size_t) {
    ASSERT_EQ(array.shape, (std::vector{kOutputs, simulation.particle_count(), std::size_t{6}}));
    for (const BodyView& body : simulation.bodies()) {
      for (std::size_t i = 0; i < body.positions.size(); ++i) {
        for (const double value : motion_of(body, i)) ASSERT_EQ(array.values.at(next++), value);
      }
    }
  });
  EXPECT_EQ(next, array.values.size());
}

std::string numbered(const char* ending, std::size_t output) {
  return "run-000" + std::to_string(output) + ending;
}

TEST(ExactOutput, Vtu) {
  const TemporaryFolder folder;
  run_program(folder, "run.pvd");
  at_each_output([&](const Simulation& simulation, std::size_t output) {
    const VtuFile file = read_vtu(folder.file(numbered(".vtu", output)));
    ASSERT_EQ(file.time, simulation.time());
    ASSERT_EQ(file.kind.size(), simulation.particle_count());
    std::size_t p = 0;
    double number = 0;
    for (const BodyView& body : simulation.bodies()) {
      const bool liquid = body.kind == BodyKind::liquid;
      const LiquidFields fields =
          liquid ? simulation.liquid_fields(body.id).value() : LiquidFields{};
      for (std::size_t i = 0; i < body.positions.size(); ++i, ++p) {
        const std::array<double, 6> motion = motion_of(body, i);
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_EQ(file.points[3 * p + c], motion[c]);
          ASSERT_EQ(file.velocity[3 * p + c], motion[3 + c]);
        }
        ASSERT_EQ(file.body[p], number);
        ASSERT_EQ(file.radius[p], body.radii[i]);
        ASSERT_EQ(file.kind[p], static_cast<double>(body.kind));
        ASSERT_EQ(file.density[p], liquid ? fields.density[i] : 0);
        ASSERT_EQ(file.pressure[p], liquid ? fields.pressure[i] : 0);
      }
      ++number;
    }
  });
}

TEST(ExactOutput, PlyInSinglePrecision) {
  const TemporaryFolder folder;
  run_program(folder, "run.ply");
  at_each_output([&](const Simulation& simulation, std::size_t output) {
    const std::vector<PlyVertex> vertices = read_ply(folder.file(numbered(".ply", output)));
    ASSERT_EQ(vertices.size(), simulation.particle_count());
    std::size_t p = 0;
    for (const BodyView& body : simulation.bodies()) {
      for (std::size_t i = 0; i < body.positions.size(); ++i, ++p) {
        const std::array<double, 6> motion = motion_of(body, i);
        for (std::size_t c = 0; c < 6; ++c) {
          ASSERT_EQ(vertices[p].values[c], static_cast<float>(motion[c]));
        }
        ASSERT_EQ(vertices[p].values[6], static_cast<float>(body.radii[i]));
      }
    }
    EXPECT_THAT(vertices.front().colour,
                testing::Not(testing::ElementsAreArray(vertices.back().colour)));
    EXPECT_EQ(vertices.front().body, 0U);
    EXPECT_EQ(vertices.back().body, 2U);
  });
}

void expect_vector(const Table& table, std::size_t row, const std::string& body,
                   const std::array<const char*, 3>& names, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string column = body + '.' + names.at(static_cast<std::size_t>(axis));
    EXPECT_EQ(table.number(row, column), v[axis]) << column;
  }
}

void expect_body(const Table& table, std::size_t row, const BodyDiagnostics& body) {
  EXPECT_EQ(table.number(row, body.name + ".mass"), body.mass);
  expect_vector(table, row, body.name, {"x", "y", "z"}, body.center_of_mass);
  expect_vector(table, row, body.name, {"px", "py", "pz"}, body.linear_momentum);
  expect_vector(table, row, body.name, {"lx", "ly", "lz"}, body.angular_momentum);
  expect_vector(table, row, body.name, {"fx", "fy", "fz"}, body.outer_force);
  expect_vector(table, row, body.name, {"tx", "ty", "tz"}, body.outer_torque);
  if (!body.orientation) return;
  const Quat& q = *body.orientation;
  EXPECT_EQ(table.number(row, body.name + ".qw"), q.w());
  expect_vector(table, row, body.name, {"qx", "qy", "qz"}, q.vec());
  expect_vector(table, row, body.name, {"wx", "wy", "wz"}, body.angular_velocity.value());
}

TEST(ExactOutput, Diagnostics) {
  const TemporaryFolder folder;
  run_program(folder, "run.npy");
  const Table table = read_csv(folder.file("d.csv"));
  ASSERT_EQ(table.rows.size(), kOutputs);
  EXPECT_EQ(table.columns[12], "pool.mass");
  EXPECT_THAT(table.columns, testing::Not(testing::Contains("pool.qw")));
  EXPECT_EQ(table.number(0, "guard_events"), 0);
  at_each_output([&](const Simulation& simulation, std::size_t row) {
    const Diagnostics d = simulation.diagnostics();
    EXPECT_EQ(table.number(row, "time"), d.time);
    EXPECT_EQ(table.number(row, "kinetic_energy"), d.kinetic_energy);
    EXPECT_EQ(table.number(row, "gravitational_energy"), d.gravitational_energy);
    EXPECT_EQ(table.number(row, "elastic_energy"), d.elastic_energy);
    EXPECT_EQ(table.number(row, "contact_energy"), d.contact_energy);
    EXPECT_EQ(table.number(row, "mean_density_error"), d.mean_density_error);
    EXPECT_EQ(table.number(row, "max_density_error"), d.max_density_error);
    EXPECT_EQ(table.number(row, "particles_outside"), static_cast<double>(d.particles_outside));
    for (const BodyDiagnostics& body : d.bodies) expect_body(table, row, body);
  });
}

TEST(ExactOutput, DiagnosticsOfAnIncompressibleLiquid) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_vat({"simulate", test_scene("column"), "--until", "0.04", "--every", "0.02", "--output",
               folder.file("run.npy"), "--diagnostics", folder.file("d.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table table = read_csv(folder.file("d.csv"));
  ASSERT_EQ(table.rows.size(), 3U);
  Simulation simulation = Simulation::create(read_scene_file(test_scene("column")).value()).value();
  simulation.advance(8);
  const Diagnostics now = simulation.diagnostics();
  const auto& [velocities, places] = now.volume.value();
  EXPECT_GT(velocities.iterations, 0);
  EXPECT_EQ(table.number(2, "velocity_iterations"), velocities.iterations);
  EXPECT_EQ(table.number(2, "mean_velocity_residual"), velocities.mean);
  EXPECT_EQ(table.number(2, "max_velocity_residual"), velocities.greatest);
  EXPECT_EQ(table.number(2, "place_iterations"), places.iterations);
  EXPECT_EQ(table.number(2, "mean_place_residual"), places.mean);
  EXPECT_EQ(table.number(2, "max_place_residual"), places.greatest);
  EXPECT_EQ(table.number(2, "column.z"), now.bodies[0].center_of_mass.z());
}

TEST(ExactOutput, HashAndProfileNameTheInstructionSet) {
  for (const char* name : {"baseline", "avx2", "avx512"}) {
    const InstructionSet set = parse_instruction_set(name).value();
    const ProgramResult result = run_vat(
        {"simulate", test_scene("mixed"), "--until", "0.02", "--hash", "--profile", "--isa", name});
    if (check_available(set)) {
      Simulation simulation =
          Simulation::create(read_scene_file(test_scene("mixed")).value(), nullptr, set).value();
      simulation.advance(20);
      std::string hash = "hash ";
      append_hash(hash, simulation.state_hash());
      EXPECT_THAT(result.out, testing::HasSubstr(hash + ' ' + name + '\n'));
      EXPECT_THAT(result.out, testing::HasSubstr(std::string("instruction set: ") + name + '\n'));
      EXPECT_THAT(result.err, testing::HasSubstr(std::string("instruction set: ") + name));
    } else {
      EXPECT_EQ(result.exit_code, 2);
      EXPECT_THAT(result.err, testing::HasSubstr(std::string("this machine has no ") + name));
    }
  }
}

}  // namespace
}  // namespace vat::test::exact_output_test
