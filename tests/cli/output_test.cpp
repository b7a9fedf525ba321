#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/cli/program.h"
#include "tests/cli/readers.h"

namespace vat::test::output_test {
namespace {

using testing::_;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

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

// No file may exceed 512 bytes. The first flush of some formats exceeds that, and the last frame of
// others.
TEST(Output, FullDiskIsAnErrorAndLeavesNoResult) {
  struct Case {
    int blocks;
    const char* until;
    const char* name;
    const char* full = name;  // the file that cannot be written
  };
  for (const auto& [blocks, until, name, full] :
       {Case{1, "0", "run.csv"}, Case{1, "0", "run.npy"}, Case{1, "0", "run.pvd", "run.vtu"},
        Case{1, "0", "run.ply"}, Case{1, "0", "run.npz"}, Case{1, "0", "run.glb"},
        Case{1, "0", "run.abc"}, Case{256, "0.4", "run.csv"}, Case{256, "0.4", "run.npy"},
        Case{256, "0.4", "run.npz"}}) {
    const TemporaryFolder folder;
    const ProgramResult result = run_vat_with_file_limit(
        blocks, {"simulate", test_scene("mixed"), "--until", until, "--output", folder.file(name)});
    EXPECT_EQ(result.exit_code, 1) << name;
    EXPECT_THAT(lines_of(result.err),
                ElementsAre(folder.file(full) + ": cannot be written: File too large"));
    EXPECT_THAT(folder.names(), Contains(std::string(full) + ".part"));
    EXPECT_THAT(folder.names(), Each(EndsWith(".part")));
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

constexpr const char* kFiles[] = {"run.csv", "run.npy", "run.npz", "run.pvd",
                                  "run.ply", "run.glb", "run.abc"};

TEST(Output, FilesThatCannotBeCreatedAreErrors) {
  const TemporaryFolder folder;
  const auto message = [&](const char* option, const std::string& file) {
    const ProgramResult result =
        run_vat({"simulate", test_scene("pair"), "--until", "0", option, folder.file(file)});
    EXPECT_EQ(result.exit_code, 1) << file;
    return result.err;
  };
  for (const char* name : kFiles) {
    std::filesystem::create_directory(folder.file(name));
    EXPECT_THAT(message("--output", name),
                StartsWith(folder.file(name) + ": cannot be created: Is a directory"));
  }
  for (const char* option : {"--output", "--diagnostics"}) {
    EXPECT_THAT(message(option, "missing/run.csv"),
                StartsWith(folder.file("missing/run.csv") + ": cannot be created: No such file"));
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
  for (const char* name : kFiles) {
    const ProgramResult result =
        run_vat({"simulate", scene, "--until", "0", "--output", folder.file(name), "--diagnostics",
                 folder.file("d.csv")});
    ASSERT_EQ(result.exit_code, 0) << name << result.err;
  }
  EXPECT_TRUE(read_csv(folder.file("run.csv")).rows.empty());
  EXPECT_THAT(read_npy(folder.file("run.npy")).shape, ElementsAre(1u, 0u, 6u));
  EXPECT_THAT(read_file(folder.file("run.npz")), StartsWith("PK"));
  EXPECT_THAT(read_file(folder.file("run.glb")), StartsWith("glTF"));
  EXPECT_THAT(read_file(folder.file("run.abc")), StartsWith("Ogawa\xff"));
  EXPECT_TRUE(read_vtu(folder.file("run.vtu")).points.empty());
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

// A pipe of the test represents all outputs that are neither file nor folder. A test with /dev/null
// could replace that device if the program had a fault and the user were root.
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
