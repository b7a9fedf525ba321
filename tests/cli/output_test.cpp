#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test::output_test {
namespace {

using testing::_;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::array<const char*, 6> kStateColumns = {"x", "y", "z", "vx", "vy", "vz"};

/// Runs the mixed scene to 0.04 s with outputs at 0, 0.02 and 0.04 s.
void write_mixed(const std::string& output, const std::string& diagnostics = "") {
  std::vector<std::string> arguments = {"simulate", test_scene("mixed"), "--until",
                                        "0.04",     "--output",          output};
  if (!diagnostics.empty()) {
    arguments.insert(arguments.end(), {"--diagnostics", diagnostics});
  }
  const ProgramResult result = run_vat(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

TEST(Output, CsvAndNpyHoldTheSameBits) {
  const TemporaryFolder folder;
  write_mixed(folder.file("run.csv"));
  write_mixed(folder.file("run.npy"));
  EXPECT_THAT(folder.names(), ElementsAre("run.csv", "run.npy"));
  const Table table = read_csv(folder.file("run.csv"));
  const Array array = read_npy(folder.file("run.npy"));
  EXPECT_THAT(table.columns, ElementsAre("time", "body", "kind", "particle", "x", "y", "z", "vx",
                                         "vy", "vz", "density", "pressure"));
  ASSERT_THAT(array.shape, ElementsAre(3u, table.rows.size() / 3, 6u));
  ASSERT_EQ(array.values.size(), table.rows.size() * 6);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t c = 0; c < 6; ++c) {
      ASSERT_EQ(table.number(row, kStateColumns[c]), array.values[row * 6 + c]) << row;
    }
  }
}

TEST(Output, CsvGivesDensityAndPressureForLiquidsOnly) {
  const TemporaryFolder folder;
  write_mixed(folder.file("run.csv"));
  const Table table = read_csv(folder.file("run.csv"));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "kind") == "liquid") {
      EXPECT_EQ(table.text(row, "body"), "pool");
      EXPECT_NEAR(table.number(row, "density"), 1000, 600);  // at the surface about half of it
      EXPECT_TRUE(std::isfinite(table.number(row, "pressure")));
    } else {
      EXPECT_EQ(table.text(row, "density"), "");
      EXPECT_EQ(table.text(row, "pressure"), "");
    }
  }
  EXPECT_EQ(table.text(table.rows.size() - 1, "body"), "ball, \"red\"");
  EXPECT_EQ(table.text(table.rows.size() - 1, "kind"), "rigid");
}

TEST(Output, VtkSeriesAgreesWithCsv) {
  const TemporaryFolder folder;
  write_mixed(folder.file("run.csv"));
  write_mixed(folder.file("run.vtk"));
  EXPECT_THAT(folder.names(),
              ElementsAre("run-0000.vtk", "run-0001.vtk", "run-0002.vtk", "run.csv"));
  const Table table = read_csv(folder.file("run.csv"));
  const VtkFile file = read_vtk(folder.file("run-0002.vtk"));
  const std::size_t count = table.rows.size() / 3;
  ASSERT_EQ(file.kind.size(), count);
  EXPECT_EQ(file.time, table.number(2 * count, "time"));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = 2 * count + i;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(file.points[3 * i + c], table.number(row, kStateColumns[c]));
      ASSERT_EQ(file.velocity[3 * i + c], table.number(row, kStateColumns[3 + c]));
    }
    const bool liquid = table.text(row, "kind") == "liquid";
    ASSERT_EQ(file.density[i], liquid ? table.number(row, "density") : 0);
    ASSERT_EQ(file.pressure[i], liquid ? table.number(row, "pressure") : 0);
    ASSERT_EQ(file.radius[i], 0.025);
  }
  EXPECT_EQ(file.body.front(), 0);
  EXPECT_EQ(file.body.back(), 2);
  EXPECT_EQ(file.kind.front(), 0);
  EXPECT_EQ(file.kind.back(), 2);
}

TEST(Output, PlyAgreesWithCsv) {
  const TemporaryFolder folder;
  write_mixed(folder.file("run.csv"));
  write_mixed(folder.file("run.ply"));
  const Table table = read_csv(folder.file("run.csv"));
  const std::size_t count = table.rows.size() / 3;
  const std::vector<PlyVertex> vertices = read_ply(folder.file("run-0001.ply"));
  ASSERT_EQ(vertices.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 6; ++c) {
      ASSERT_EQ(vertices[i].values[c],
                static_cast<float>(table.number(count + i, kStateColumns[c])));
    }
    ASSERT_EQ(vertices[i].values[6], 0.025f);
  }
  EXPECT_THAT(vertices.front().colour,
              testing::Not(testing::ElementsAreArray(vertices.back().colour)));
  EXPECT_EQ(vertices.front().body, 0u);
  EXPECT_EQ(vertices.back().body, 2u);
}

TEST(Output, OneTimeIsOneFile) {
  const TemporaryFolder folder;
  const ProgramResult result = run_vat(
      {"simulate", test_scene("pair"), "--until", "0", "--output", folder.file("start.ply")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(folder.names(), ElementsAre("start.ply"));
  const std::vector<PlyVertex> vertices = read_ply(folder.file("start.ply"));
  ASSERT_EQ(vertices.size(), 2u);
  EXPECT_EQ(vertices[0].values[0], -0.55f);
}

// The two columns come from different code: sums over the particles' rows against the diagnostics.
// Bounds: round-off of sums of two terms.
TEST(Output, DiagnosticsAgreeWithParticles) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_vat({"simulate", test_scene("pair"), "--until", "0.4", "--every", "0.1", "--output",
               folder.file("run.csv"), "--diagnostics", folder.file("d.csv")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Table particles = read_csv(folder.file("run.csv"));
  const Table table = read_csv(folder.file("d.csv"));
  ASSERT_EQ(table.rows.size(), 5u);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const double x0 = particles.number(2 * row, "x");
    const double x1 = particles.number(2 * row + 1, "x");
    const double v0 = particles.number(2 * row, "vx");
    const double v1 = particles.number(2 * row + 1, "vx");
    EXPECT_EQ(table.number(row, "time"), particles.number(2 * row, "time"));
    EXPECT_EQ(table.number(row, "pair.mass"), 2);
    EXPECT_NEAR(table.number(row, "pair.x"), (x0 + x1) / 2, 1e-15);
    EXPECT_NEAR(table.number(row, "pair.px"), v0 + v1, 1e-15);
    EXPECT_NEAR(table.number(row, "kinetic_energy"), (v0 * v0 + v1 * v1) / 2, 1e-14);
    const double stretch = x1 - x0 - 1;
    EXPECT_NEAR(table.number(row, "elastic_energy"), 50 * stretch * stretch, 1e-12);
    EXPECT_EQ(table.number(row, "guard_events"), 0);
  }
}

TEST(Output, DiagnosticsOfRigidBodiesHaveOrientationAndSpin) {
  const TemporaryFolder folder;
  write_mixed(folder.file("run.npy"), folder.file("d.csv"));
  const Table table = read_csv(folder.file("d.csv"));
  const std::string ball = "ball, \"red\".";
  EXPECT_EQ(table.columns[12], "pool.mass");
  EXPECT_THAT(table.columns, testing::Not(testing::Contains("pool.qw")));
  EXPECT_EQ(table.columns.back(), ball + "wz");
  EXPECT_EQ(table.number(0, ball + "qw"), 1);
  EXPECT_NEAR(table.number(0, ball + "wy"), 3, 1e-12);
  // In free flight a body that spins about a principal axis turns by w t.
  EXPECT_NEAR(table.number(1, ball + "qy"), std::sin(3 * 0.02 / 2), 1e-9);
}

// No file may grow beyond 512 bytes, which the first flush of each format does.
TEST(Output, FullDiskIsAnErrorAndLeavesNoResult) {
  for (const char* name : {"run.csv", "run.npy", "run.vtk", "run.ply"}) {
    const TemporaryFolder folder;
    const ProgramResult result = run_vat_with_file_limit(
        1, {"simulate", test_scene("mixed"), "--until", "0", "--output", folder.file(name)});
    EXPECT_EQ(result.exit_code, 1) << name;
    EXPECT_THAT(lines_of(result.err),
                ElementsAre(folder.file(name) + ": cannot be written: File too large"));
    EXPECT_THAT(folder.names(), ElementsAre(std::string(name) + ".part"));
  }
}

// As on a disk that fills up: some frames fit, the last does not.
TEST(Output, DiskThatFillsUpIsAnErrorAndLeavesNoResult) {
  for (const char* name : {"run.csv", "run.npy"}) {
    const TemporaryFolder folder;
    const ProgramResult result = run_vat_with_file_limit(
        256, {"simulate", test_scene("mixed"), "--until", "0.4", "--output", folder.file(name)});
    EXPECT_EQ(result.exit_code, 1) << name;
    EXPECT_THAT(lines_of(result.err),
                ElementsAre(folder.file(name) + ": cannot be written: File too large"));
    EXPECT_THAT(folder.names(), ElementsAre(std::string(name) + ".part"));
  }
}

TEST(Output, FullDiskForDiagnosticsIsAnError) {
  const TemporaryFolder folder;
  const std::string file = folder.file("d.csv");
  const ProgramResult result = run_vat_with_file_limit(
      1, {"simulate", test_scene("mixed"), "--until", "0.02", "--diagnostics", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(lines_of(result.err), ElementsAre(file + ": cannot be written: File too large"));
}

TEST(Output, FolderInPlaceOfAFileIsAnError) {
  const TemporaryFolder folder;
  for (const char* name : {"run.csv", "run.npy", "run.vtk", "run.ply"}) {
    std::filesystem::create_directory(folder.file(name));
    const ProgramResult result =
        run_vat({"simulate", test_scene("pair"), "--until", "0", "--output", folder.file(name)});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, StartsWith(folder.file(name) + ": cannot be created: Is a directory"));
  }
}

TEST(Output, OldResultStaysUntilTheNewOneIsComplete) {
  const TemporaryFolder folder;
  const std::string file = folder.file("run.csv");
  std::ofstream(file) << "old";
  const ProgramResult failed =
      run_vat({"simulate", test_scene("unstable"), "--until", "1", "--output", file});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(read_file(file), "old");
  const ProgramResult fine =
      run_vat({"simulate", test_scene("pair"), "--until", "0", "--output", file});
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
  EXPECT_EQ(read_csv(file).rows.size(), 2u);
}

TEST(Output, SceneWithoutBodiesHasNoRows) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("empty.json");
  std::ofstream(scene) << R"({"format": "vat.scene/1", "materials": [], "bodies": []})";
  for (const char* name : {"run.csv", "run.npy", "run.vtk", "run.ply"}) {
    const ProgramResult result =
        run_vat({"simulate", scene, "--until", "0", "--output", folder.file(name), "--diagnostics",
                 folder.file("d.csv")});
    ASSERT_EQ(result.exit_code, 0) << name << result.err;
  }
  EXPECT_TRUE(read_csv(folder.file("run.csv")).rows.empty());
  EXPECT_THAT(read_npy(folder.file("run.npy")).shape, ElementsAre(1u, 0u, 6u));
  EXPECT_TRUE(read_vtk(folder.file("run.vtk")).points.empty());
  EXPECT_TRUE(read_ply(folder.file("run.ply")).empty());
  const Table diagnostics = read_csv(folder.file("d.csv"));
  EXPECT_EQ(diagnostics.number(0, "kinetic_energy"), 0);
}

TEST(Output, FullStandardOutputIsAnError) {
  const ProgramResult result =
      run_vat_with_file_limit(1, {"simulate", "sliding-vat-liquid", "--plan"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("standard output cannot be written"));
}

TEST(Output, MissingFolderIsAnError) {
  const TemporaryFolder folder;
  for (const char* option : {"--output", "--diagnostics"}) {
    const std::string file = folder.file("missing/run.csv");
    const ProgramResult result =
        run_vat({"simulate", test_scene("pair"), "--until", "0.02", option, file});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, StartsWith(file + ": cannot be created: No such file or directory"));
  }
}

// A pipe of the test's own stands for all that is neither file nor folder: a test that named
// /dev/null would replace that device of the machine, were the program wrong and the user root.
TEST(Output, PipesAndDevicesAreWrittenAndNotReplaced) {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  const Pipe reader(pipe);
  std::filesystem::create_symlink(pipe, folder.file("link.csv"));
  const ProgramResult result = run_vat(
      {"simulate", test_scene("pair"), "--until", "0.02", "--output", folder.file("link.csv")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines_of(reader.content()), ElementsAre(StartsWith("time,body,"), _, _, _, _));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.csv")));
  EXPECT_THAT(folder.names(), ElementsAre("link.csv", "pipe"));
}

}  // namespace
}  // namespace vat::test::output_test
