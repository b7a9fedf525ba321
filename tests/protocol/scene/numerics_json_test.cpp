#include <gtest/gtest.h>

#include "protocol/scene/scene_json.h"

// The numerics of a scene file: valid combinations, and the derived values.

namespace vat::numerics_json_test {
namespace {

/// Reads an oscillator scene with these numerics.
Result<Scene> read(const std::string& numerics) {
  const std::string text = R"({"format": "vat.scene/1",
    "materials": [{"name": "steel"}],
    "numerics": )" + numerics +
                           R"(,
    "bodies": [{"name": "swing", "kind": "deformable", "material": "steel", "radius": 0.01,
      "shape": {"type": "particles", "positions": [[0, 0, 0], [1, 0, 0]], "masses": [1, 1]},
      "springs": [{"particles": [0, 1], "stiffness": 100}]}]})";
  return read_scene_text(text, {});
}

TEST(NumericsJson, AccuracyChoosesTheRestWhichIsNotWritten) {
  const Result<Scene> scene = read(R"({"accuracy": 1e-3, "tick": 0.05})");
  ASSERT_TRUE(scene) << scene.errors()[0].message;
  const Numerics& numerics = scene.value().numerics;
  EXPECT_EQ(numerics.accuracy, 1e-3);
  EXPECT_EQ(numerics.tick, 0.05);
  EXPECT_EQ(numerics.integrator, IntegratorId::runge_kutta_4);
  // z^4 / 120 = 1e-5 and omega^2 <= 2 * 100 give 0.186 / 14.1 s.
  EXPECT_NEAR(numerics.step, 0.05 / 4, 1e-12);
  EXPECT_EQ(write_scene(scene.value())["numerics"], (Json{{"accuracy", 1e-3}, {"tick", 0.05}}));
}

TEST(NumericsJson, NothingThatAccuracyChoosesMayStandBesideIt) {
  for (const char* other : {R"("integrator": "heun")", R"("step": 1e-3)",
                            R"("control": "adaptive")", R"("tolerance": 1e-3)"}) {
    const Result<Scene> scene = read(R"({"accuracy": 1e-3, )" + std::string(other) + "}");
    ASSERT_FALSE(scene) << other;
    ASSERT_EQ(scene.errors().size(), 1U);
    EXPECT_EQ(scene.errors()[0].code, "not_allowed");
    const std::string member = std::string(other).substr(1, std::string(other).find('"', 1) - 1);
    EXPECT_EQ(scene.errors()[0].path, "/numerics/" + member);
  }
}

TEST(NumericsJson, RangesAreNamed) {
  for (const char* member : {"accuracy", "tolerance"}) {
    for (const char* value : {"0", "-1", "1.1", "1e-9", "null", "\"high\""}) {
      const Result<Scene> scene = read("{\"" + std::string(member) + "\": " + value + "}");
      ASSERT_FALSE(scene) << member << ' ' << value;
      EXPECT_EQ(scene.errors()[0].path, "/numerics/" + std::string(member));
    }
  }
}

TEST(NumericsJson, DevicesAreReadAndWritten) {
  for (const char* device : {"cpu", "auto", "opencl:1", "opencl:2:fast"}) {
    for (const char* others : {"", R"("accuracy": 1e-3, )"}) {
      const Result<Scene> scene =
          read("{" + std::string(others) + R"("device": ")" + device + "\"}");
      ASSERT_TRUE(scene) << device;
      EXPECT_EQ(scene.value().numerics.device, parse_device(device).value());
      EXPECT_EQ(write_scene(scene.value())["numerics"]["device"], device);
    }
  }
  EXPECT_FALSE(write_scene(read("{}").value())["numerics"].contains("device"));
  for (const auto& [device, code] : {std::pair{"\"gpu\"", "bad_value"}, {"0", "wrong_type"}}) {
    const Result<Scene> scene = read(R"({"device": )" + std::string(device) + "}");
    ASSERT_FALSE(scene) << device;
    EXPECT_EQ(scene.errors()[0].path, "/numerics/device");
    EXPECT_EQ(scene.errors()[0].code, code);
  }
}

TEST(NumericsJson, LocalControlNeedsVelocityVerlet) {
  EXPECT_TRUE(read(R"({"control": "local"})"));
  const Result<Scene> scene = read(R"({"control": "local", "integrator": "heun"})");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.errors()[0].path, "/numerics/control");
  EXPECT_NE(scene.errors()[0].message.find("heun"), std::string::npos);
  EXPECT_NE(scene.errors()[0].message.find("velocity_verlet"), std::string::npos);
}

}  // namespace
}  // namespace vat::numerics_json_test
