#include "protocol/recording/frame_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/frame/frame_domain.h"
#include "protocol/json/json_reader.h"
#include "protocol/scene/scene_json.h"
#include "tests/support/scenes.h"

// Frames of a recording: their precision, their key frames, and the continuation.

namespace vat::test::frame_recorder_test {
namespace {

using testing::ElementsAre;

using Bytes = std::vector<std::uint8_t>;

constexpr Real kTick = 0.01;

/// Two bodies that fall apart; without a vat, so that they leave each grid.
Simulation make_simulation() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kTick);
  scene.gravity = Vec3(0, 0, -10);
  scene.materials = {make_material("rubber")};
  scene.bodies = {make_body("pair", BodyKind::deformable, "rubber",
                            make_particles({Vec3(0, 0, 0), Vec3(1, 0, 0)}, 1), 0.05),
                  make_body("single", BodyKind::deformable, "rubber",
                            make_particles({Vec3(0, 2, 0)}, 1), 0.05)};
  return Simulation::create(scene).value();
}

RecorderSettings settings(std::optional<std::size_t> key_every = 4) {
  return {kTick, std::nullopt, key_every};
}

struct Recorded {
  std::vector<Bytes> frames;
  std::vector<std::string> descriptions;
};

void record(Simulation& simulation, FrameRecorder& recorder, std::size_t count, Recorded& to) {
  for (std::size_t f = 0; f < count; ++f) {
    const FrameRecorder::Parts parts = recorder.record(simulation);
    if (parts.description) to.descriptions.push_back(*parts.description);
    to.frames.emplace_back(parts.frame.begin(), parts.frame.end());
    simulation.advance(1);
  }
}

TEST(FrameRecorder, FramesHaveTheStatedError) {
  Simulation simulation = make_simulation();
  FrameRecorder recorder(settings());
  FrameDecoder decoder;
  const double max_error = default_max_error(simulation);
  ASSERT_GT(max_error, 0);
  for (std::uint32_t f = 0; f < 100; ++f) {
    const FrameRecorder::Parts parts = recorder.record(simulation);
    const Result<const GridFrame*> frame = decoder.decode(parts.frame);
    ASSERT_TRUE(frame.ok()) << frame.errors()[0].message;
    const auto& [header, scale, detail, has_region, blocks] = *frame.value();
    EXPECT_EQ(header.tick, f);
    EXPECT_EQ(header.number, f + 1);
    EXPECT_EQ(header.time, simulation.time());
    const auto bodies = simulation.bodies();
    ASSERT_EQ(blocks.size(), bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      for (std::size_t i = 0; i < bodies[b].positions.size(); ++i) {
        for (std::size_t q = 0; q < 3; ++q) {
          const double x =
              scale.grid.origin[q] + scale.grid.quantum * blocks[b].positions[3 * i + q];
          ASSERT_NEAR(x, bodies[b].positions[i][static_cast<int>(q)], 1.001 * max_error) << f;
        }
      }
    }
    simulation.advance(1);
  }
}

TEST(FrameRecorder, KeyFramesHaveTheGivenDistance) {
  Simulation simulation = make_simulation();
  FrameRecorder recorder(settings(3));
  Recorded recorded;
  record(simulation, recorder, 7, recorded);
  std::vector<bool> keys;
  for (const Bytes& frame : recorded.frames) keys.push_back(is_key_frame(frame));
  EXPECT_THAT(keys, ElementsAre(true, false, false, true, false, false, true));
  EXPECT_EQ(recorded.descriptions.size(), 1U);
}

TEST(FrameRecorder, DefaultIntervalBoundsTheWorkOfASeek) {
  EXPECT_EQ(default_key_interval(0), 60U);
  EXPECT_EQ(default_key_interval(1000), 60U);
  EXPECT_EQ(default_key_interval(100'000), 5U);
  EXPECT_EQ(default_key_interval(1'000'000), 4U);
}

// A recording that is interrupted after each of its frames has the same bytes.
TEST(FrameRecorder, ContinuesWithTheSameBytes) {
  Simulation simulation = make_simulation();
  FrameRecorder recorder(settings());
  Recorded whole;
  record(simulation, recorder, 60, whole);
  for (std::size_t cut = 1; cut < 59; ++cut) {
    Simulation again = make_simulation();
    FrameRecorder resumed(settings());
    std::size_t first = cut - 1;
    while (!is_key_frame(whole.frames[first])) --first;
    for (std::size_t f = first; f < cut; ++f) ASSERT_TRUE(resumed.read(whole.frames[f], f).ok());
    again.advance(static_cast<std::uint32_t>(cut));
    Recorded rest;
    record(again, resumed, 60 - cut, rest);
    ASSERT_TRUE(std::equal(rest.frames.begin(), rest.frames.end(),
                           whole.frames.begin() + static_cast<std::ptrdiff_t>(cut)))
        << cut;
    EXPECT_TRUE(rest.descriptions.empty());
  }
}

TEST(FrameRecorder, RefusesADamagedFrame) {
  Simulation simulation = make_simulation();
  FrameRecorder recorder(settings());
  Recorded recorded;
  record(simulation, recorder, 1, recorded);
  recorded.frames[0].pop_back();
  EXPECT_FALSE(FrameRecorder(settings()).read(recorded.frames[0], 0).ok());
}

TEST(FrameRecorder, ABodyThatMeltsBeginsADescription) {
  const Result<Scene> scene = read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/melting.json");
  ASSERT_TRUE(scene.ok());
  Scene soon = scene.value();
  for (BodyDescription& body : soon.bodies) {
    if (body.melting) body.melting->at = 0.03;
  }
  Simulation simulation = Simulation::create(soon).value();
  FrameRecorder recorder({0.02, std::nullopt, 60});
  FrameDecoder decoder;
  std::vector<std::uint32_t> epochs;
  std::vector<std::string> kinds;
  for (int f = 0; f < 4; ++f) {
    const FrameRecorder::Parts parts = recorder.record(simulation);
    if (parts.description) {
      const Json json = Json::parse(*parts.description);
      epochs.push_back(json.at("epoch"));
      kinds.push_back(json.at("bodies").at(1).at("kind"));
      EXPECT_TRUE(is_key_frame(parts.frame));
    }
    const Result<const GridFrame*> frame = decoder.decode(parts.frame);
    ASSERT_TRUE(frame.ok()) << frame.errors()[0].message;
    EXPECT_EQ(frame.value()->header.epoch, epochs.back());
    simulation.advance(simulation.steps_per_tick());
  }
  EXPECT_THAT(epochs, ElementsAre(1, 2));
  EXPECT_THAT(kinds, ElementsAre("deformable", "liquid"));
}

}  // namespace
}  // namespace vat::test::frame_recorder_test
