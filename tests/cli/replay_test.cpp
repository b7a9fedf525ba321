// `vat replay` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/simulation/simulation.h"
#include "protocol/scene/scene_json.h"
#include "server/history/recording.h"
#include "tests/cli/program.h"

namespace vat::test::replay_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class VatReplay : public testing::Test {
 protected:
  /// A scene that runs for five ticks, and for five more with another gravity.
  static Recording make_recording() {
    const Scene scene = read_scene_file(test_scene("pair")).value();
    Recording recording;
    recording.program = "0.1.0";
    recording.instructions = best_instruction_set();
    recording.name = "pair";
    recording.end = 10;
    recording.log = {{1, 0, 0, 0, "scene.load", Json{{"scene", write_scene(scene)}}.dump(), false},
                     {2, 5, 5, 1, "world.set_gravity", R"({"gravity":[0,0,3]})", false}};
    Simulation simulation = Simulation::create(scene).value();
    simulation.advance(5 * simulation.steps_per_tick());
    recording.hashes.push_back({5, 1, simulation.state_hash()});
    EXPECT_TRUE(simulation.set_gravity({0, 0, 3}).ok());
    simulation.advance(5 * simulation.steps_per_tick());
    recording.hashes.push_back({10, 2, simulation.state_hash()});
    return recording;
  }
  std::string write(const std::vector<std::uint8_t>& bytes) {
    folder_.write("a.vatrec", std::string(bytes.begin(), bytes.end()));
    return folder_.file("a.vatrec");
  }

  TemporaryFolder folder_;
};

TEST_F(VatReplay, ComparesEveryStateAndSucceeds) {
  const ProgramResult result =
      run_vat({"replay", "--verify", write(write_recording(make_recording()))});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("position 5, tick 5, hash "));
  EXPECT_THAT(result.out, HasSubstr("position 10, tick 10, hash "));
  EXPECT_THAT(result.out, HasSubstr("10 ticks, 2 entries, 2 hashes the same, in "));
  EXPECT_THAT(result.err, IsEmpty());
}

// Recordings of earlier versions with the present numerics, made with the baseline instruction set.
TEST_F(VatReplay, RepeatsRecordingsOfEarlierVersions) {
  int count = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(VAT_SOURCE_DIR "/tests/golden/recordings")) {
    const ProgramResult result = run_vat({"replay", "--verify", file.path().string()});
    EXPECT_EQ(result.exit_code, 0) << file.path() << ": " << result.err;
    EXPECT_THAT(result.out, HasSubstr(" hashes the same, in "));
    ++count;
  }
  EXPECT_GE(count, 1);
}

TEST_F(VatReplay, ReportsTheFirstDifferentTick) {
  Recording recording = make_recording();
  recording.hashes[1].hash ^= 1;
  const ProgramResult result = run_vat({"replay", write(write_recording(recording))});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("a.vatrec: differs: at tick 10 the state has the hash "));
  EXPECT_THAT(result.err, HasSubstr("; the states are equal up to tick 5\n"));
}

TEST_F(VatReplay, VerifiesNothingWithoutHashes) {
  Recording recording = make_recording();
  recording.hashes.clear();
  const std::string file = write(write_recording(recording));
  EXPECT_EQ(run_vat({"replay", file}).exit_code, 0);
  EXPECT_THAT(run_vat({"replay", "--verify", file}),
              exits(1, HasSubstr("there is no hash to compare with")));
}

TEST_F(VatReplay, RefusesOtherFiles) {
  EXPECT_THAT(run_vat({"replay", test_scene("pair")}),
              exits(1, HasSubstr("these are not the bytes of a recording")));
  EXPECT_EQ(run_vat({"replay", folder_.file("none")}).exit_code, 2);
}

TEST_F(VatReplay, RefusesACommandThatItCannotRead) {
  Recording recording = make_recording();
  recording.log[1].params = R"({"gravity":"up"})";
  EXPECT_THAT(run_vat({"replay", write(write_recording(recording))}),
              exits(1, HasSubstr("entry 2 (world.set_gravity): /gravity")));
}

}  // namespace
}  // namespace vat::test::replay_test
