#include "protocol/convert/splishsplash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::splishsplash_test {
namespace {

using scene_cases::lines;
using scene_cases::no_meshes;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kFolder = VAT_SOURCE_DIR "/tests/protocol/convert/scenes";

Json source(const std::string& name) {
  const Result<std::string> text = meshes_relative_to(kFolder)(name + ".json");
  return parse_json(text.value(), kSplishsplashLimits).value();
}

Result<ConvertedScene> convert(const Json& document) {
  return convert_splishsplash(document, meshes_relative_to(kFolder));
}

ConvertedScene converted(const std::string& name) {
  const Result<ConvertedScene> result = convert(source(name));
  EXPECT_EQ(lines(result), "");
  return result.value();
}

std::vector<std::string> omitted_paths(const ConvertedScene& scene) {
  std::vector<std::string> paths;
  for (const Omission& omission : scene.omissions) paths.push_back(omission.path);
  return paths;
}

Json json(const char* text) {
  return Json::parse(text);
}

TEST(ConvertSplishsplash, DamBreakKeepsItsBlocksMaterialsAndContainer) {
  const Json scene = converted("dam_break").document;
  EXPECT_EQ(scene["bodies"], json(R"([
      {"name": "block 1", "kind": "liquid", "material": "Water", "spacing": 0.1,
       "shape": {"type": "box", "center": [-1.5, 0, 0.5], "size": [1, 1, 1]}},
      {"name": "block 2", "kind": "liquid", "material": "Oil", "spacing": 0.1,
       "shape": {"type": "box", "center": [1.25, 0, 0.9], "size": [0.5, 1, 0.8]},
       "velocity": [-1, -3, 2]}])"));
  EXPECT_EQ(scene["materials"], json(R"([
      {"name": "Water", "density": 998,
       "liquid": {"stiffness": 0, "viscosity": 9.98, "support_radius": 0.2}},
      {"name": "Oil", "density": 800,
       "liquid": {"stiffness": 0, "viscosity": 0, "support_radius": 0.2}}])"));
  EXPECT_EQ(scene["vat"], json(R"({"min": [-2, -0.6, 0], "max": [2, 0.6, 2], "lid": true})"));
  EXPECT_EQ(scene["pressure_solver"], "incompressible");
  EXPECT_EQ(scene["incompressible"],
            json(R"({"density_tolerance": 0.0005, "divergence_tolerance": 0.001,
                     "most_iterations": 50})"));
  EXPECT_EQ(scene["numerics"], json(R"({"integrator": "symplectic_euler", "step": 0.005,
                                        "tick": 0.02, "control": "adaptive"})"));
  EXPECT_FALSE(scene.contains("gravity"));  // it is the default
}

TEST(ConvertSplishsplash, DamBreakReportsEachMemberThatIsNotInTheScene) {
  EXPECT_THAT(omitted_paths(converted("dam_break")),
              testing::UnorderedElementsAre(
                  "/Configuration/DFSPH/enableDivergenceSolver", "/Configuration/pause",
                  "/Configuration/cameraPosition", "/Configuration/cflFactor",
                  "/Configuration/timeStepSize", "/Materials/0/colorMapType",
                  "/Materials/0/surfaceTensionMethod", "/Materials/0/surfaceTension",
                  "/Materials/1/viscosityMethod", "/Materials/1/viscosity", "/Materials/2",
                  "/FluidBlocks/1/denseMode", "/RigidBodies/0/color", "/RigidBodies/0/isWall"));
}

TEST(ConvertSplishsplash, ObstaclesAreCutAtTheContainer) {
  const ConvertedScene result = converted("obstacle");
  const Json& scene = result.document;
  EXPECT_EQ(scene["title"], "A pyramid in a flood");
  EXPECT_EQ(scene["vat"], json(R"({"min": [-1.5, -0.6, 0], "max": [1.5, 0.6, 2], "lid": true})"));
  ASSERT_EQ(scene["bodies"].size(), 3U);
  const Json& pyramid = scene["bodies"][1];
  EXPECT_EQ(pyramid["fixed"], true);
  EXPECT_EQ(pyramid["shape"]["type"], "mesh");
  EXPECT_THAT(pyramid["shape"]["vertices"],
              testing::UnorderedElementsAre(json("[0.1, 0.4, 0]"), json("[0.9, 0.4, 0]"),
                                            json("[0.9, -0.4, 0]"), json("[0.1, -0.4, 0]"),
                                            json("[0.5, 0, 0.7]")));
  EXPECT_THAT(omitted_paths(result),
              testing::IsSupersetOf({"/RigidBodies/0", "/RigidBodies/3", "/RigidBodies/1/isWall"}));
}

TEST(ConvertSplishsplash, DynamicBodiesKeepTheirMotionAndContacts) {
  const Json scene = converted("obstacle").document;
  const Json& body = scene["bodies"][2];
  EXPECT_EQ(body["kind"], "rigid");
  EXPECT_FALSE(body.contains("fixed"));
  EXPECT_EQ(body["shape"], json(R"({"type": "box", "size": [0.4, 0.4, 0.4]})"));
  EXPECT_EQ(body["position"], json("[-0.2, 0, 1.4]"));
  EXPECT_EQ(body["velocity"], json("[0, 0, -1]"));
  // About z of the source, which is -y of the scene.
  EXPECT_NEAR(body["orientation"][0].get<Real>(), std::cos(0.25), 1e-12);
  EXPECT_NEAR(body["orientation"][2].get<Real>(), -std::sin(0.25), 1e-12);
  const auto material_of = [&](const std::string& name) {
    for (const Json& material : scene["materials"]) {
      if (material["name"] == name) return material;
    }
    return Json();
  };
  EXPECT_EQ(material_of(body["material"])["density"], 500);
  const Json obstacle = material_of(scene["bodies"][1]["material"]);
  EXPECT_EQ(obstacle["appearance"], json(R"({"colour": "#ff8000"})"));
  // Products of restitutions, and sums of coefficients of friction; by default 0.6 and 0.2.
  EXPECT_THAT(scene["interfaces"], Contains(Json{{"materials", {body["material"], "vat"}},
                                                 {"law", "projection"},
                                                 {"restitution", 0.3},
                                                 {"friction", 0.3}}));
}

TEST(ConvertSplishsplash, WeaklyCompressibleLiquidsKeepTheirSpeedOfSound) {
  const Json scene = converted("obstacle").document;
  EXPECT_FALSE(scene.contains("pressure_solver"));
  EXPECT_EQ(scene["materials"][0]["liquid"]["stiffness"], 7 * 50'000 / 1000.0);
  EXPECT_EQ(scene["numerics"], json(R"({"integrator": "velocity_verlet", "step": 0.002,
                                        "tick": 0.02, "control": "fixed"})"));
}

TEST(ConvertSplishsplash, EmittersKeepTheirOpeningAndFlow) {
  const Json scene = converted("emitter").document;
  ASSERT_EQ(scene["bodies"].size(), 1U);  // one particle, which the emitters need
  EXPECT_EQ(scene["bodies"][0]["shape"]["size"], json("[0.04, 0.04, 0.04]"));
  EXPECT_EQ(scene["emitters"], json(R"([
      {"name": "emitter 1", "body": "drop 1", "position": [-0.82, 0, 0.7], "direction": [1, 0, 0],
       "size": [0.2, 0.12], "speed": 2, "until": 4, "most_particles": 3001},
      {"name": "emitter 2", "body": "drop 1", "position": [0.5, 0, 0.82], "direction": [0, 0, -1],
       "radius": 0.08, "speed": 1, "from": 0.5, "most_particles": 3001}])"));
  EXPECT_EQ(scene["materials"][0]["liquid"]["viscosity"], 2);
  EXPECT_EQ(scene["numerics"]["step"], 0.01);  // one layer takes 0.02 s
}

TEST(ConvertSplishsplash, ElasticBlocksAreDeformableBodies) {
  Json document = source("dam_break");
  document["Materials"][0]["elasticityMethod"] = 1U;
  document["Materials"][0]["youngsModulus"] = 50'000U;
  const Json scene = convert(document).value().document;
  EXPECT_EQ(scene["bodies"][0]["kind"], "deformable");
  // 0.4 × modulus × spacing, see materials.cpp
  EXPECT_EQ(scene["materials"][0]["springs"],
            json(R"({"structural": {"stiffness": 2000}, "shear": {"stiffness": 2000}})"));
  EXPECT_EQ(scene["default_interface"]["law"], "projection");
}

TEST(ConvertSplishsplash, ModelsOfMeshesAreBodiesAndParticleFilesAreOmitted) {
  Json document = source("dam_break");
  document["FluidModels"] = json(R"([
      {"particleFile": "meshes/pyramid.obj", "translation": [0, 1, 0], "scale": 0.5, "id": "Oil"},
      {"particleFile": "meshes/pyramid.bgeo"}])");
  const ConvertedScene result = convert(document).value();
  const Json& body = result.document["bodies"][2];
  EXPECT_EQ(body["position"], json("[0, 0, 1]"));
  EXPECT_EQ(body["shape"]["vertices"].size(), 5U);
  EXPECT_THAT(body["shape"]["vertices"], Contains(json("[0, 0, 0.5]")));
  EXPECT_THAT(omitted_paths(result), Contains("/FluidModels/1"));
}

TEST(ConvertSplishsplash, TwoDimensionalScenesAreInThePlane) {
  Json document = source("emitter");
  document["Configuration"]["sim2D"] = true;
  document["FluidBlocks"] = json(R"([{"start": [-0.5, 0.1, -1], "end": [0.5, 0.3, 1]}])");
  const Result<ConvertedScene> result = convert(document);
  ASSERT_EQ(lines(result), "");
  const Json& scene = result.value().document;
  EXPECT_EQ(scene["dimensions"], 2);
  EXPECT_EQ(scene["bodies"][0]["shape"],
            json(R"({"type": "box", "center": [0, 0, 0.2], "size": [1, 0.04, 0.2]})"));
  EXPECT_EQ(scene["emitters"][0]["radius"], 0.06);
}

TEST(ConvertSplishsplash, EmittersShareTheParticlesOfAScene) {
  Json document = source("emitter");
  document["Materials"][0]["maxEmitterParticles"] = 10'000'000U;
  const Result<ConvertedScene> result = convert(document);
  ASSERT_EQ(lines(result), "");
  EXPECT_LE(result.value().document["emitters"][0]["most_particles"].get<std::size_t>(),
            1'000'000U);
  EXPECT_THAT(omitted_paths(result.value()), Contains("/Emitters/1"));
}

TEST(ConvertSplishsplash, EveryUnknownMemberIsReported) {
  Json document = source("dam_break");
  const std::vector<std::string> objects = {"",
                                            "/Configuration",
                                            "/Configuration/DFSPH",
                                            "/Materials/0",
                                            "/FluidBlocks/0",
                                            "/RigidBodies/0"};
  for (const std::string& object : objects) {
    document[Json::json_pointer(object)]["novelty"] = 1;
  }
  const std::vector<std::string> paths = omitted_paths(convert(document).value());
  for (const std::string& object : objects) EXPECT_THAT(paths, Contains(object + "/novelty"));
}

struct Mistake {
  const char* path;  ///< member that is replaced or added
  const char* value;
  const char* error;  ///< path of the error
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.path;
}

class WrongSplishsplash : public testing::TestWithParam<Mistake> {};

TEST_P(WrongSplishsplash, IsRefusedWithThePathOfTheMember) {
  Json document = source("dam_break");
  document[Json::json_pointer(GetParam().path)] = json(GetParam().value);
  const Result<ConvertedScene> result = convert(document);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.errors().front().path, GetParam().error);
  EXPECT_FALSE(result.errors().front().message.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, WrongSplishsplash,
    testing::Values(
        Mistake{"/Configuration", "7", "/Configuration"},
        Mistake{"/Configuration/particleRadius", "0", "/Configuration/particleRadius"},
        Mistake{"/Configuration/particleRadius", "\"5\"", "/Configuration/particleRadius"},
        Mistake{"/Configuration/simulationMethod", "9", "/Configuration/simulationMethod"},
        Mistake{"/Configuration/gravitation", "[0, -9.81]", "/Configuration/gravitation"},
        Mistake{"/Configuration/cflMaxTimeStepSize", "-1", "/Configuration/cflMaxTimeStepSize"},
        Mistake{"/Configuration/DFSPH/maxError", "true", "/Configuration/DFSPH/maxError"},
        Mistake{"/Materials", "{}", "/Materials"},
        Mistake{"/Materials/0/density0", "-998", "/Materials/0/density0"},
        Mistake{"/FluidBlocks/0/end", "[-3, 1, 1]", "/FluidBlocks/0/end"},
        Mistake{"/FluidBlocks/0/start", "[1e7, 0, 0]", "/FluidBlocks/0/start/0"},
        Mistake{"/FluidBlocks/1", "null", "/FluidBlocks/1"},
        Mistake{"/FluidBlocks/1/translation", "[9, 0, 0]", "/FluidBlocks/1"},  // outside
        Mistake{"/RigidBodies/0/geometryFile", "\"none.obj\"", "/RigidBodies/0/geometryFile"},
        Mistake{"/RigidBodies/0/geometryFile", "\"dam_break.json\"", "/RigidBodies/0/geometryFile"},
        Mistake{"/RigidBodies/0/scale", "[1, 0, 1]", "/RigidBodies/0/scale/1"},
        Mistake{"/RigidBodies/0/isDynamic", "2", "/RigidBodies/0/isDynamic"}));

TEST(SceneText, IsTheDocumentInShortLines) {
  for (const char* name : {"dam_break", "obstacle", "emitter"}) {
    const Json scene = converted(name).document;
    const std::string text = scene_text(scene);
    EXPECT_EQ(parse_json(text).value(), scene);
    EXPECT_EQ(lines(read_scene_text(text, no_meshes)), "");
    EXPECT_EQ(text.back(), '\n');
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) EXPECT_LE(line.size(), 120U);
    EXPECT_THAT(text, Not(HasSubstr("\n\n")));
  }
}

}  // namespace
}  // namespace vat::splishsplash_test
