#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/saved/saved_fields.h"
#include "core/simulation/simulation.h"
#include "tests/protocol/scene/scene_json_cases.h"

namespace vat::scene_json_test {
namespace {

using namespace scene_cases;
using testing::HasSubstr;
using testing::StartsWith;

using Pointer = Json::json_pointer;

/// Collects the pointers of all values below the root of `value`.
void collect(const Json& value, const Pointer& at, std::vector<Pointer>& pointers) {
  if (!at.empty()) pointers.push_back(at);
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) collect(member, at / key, pointers);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) collect(value[i], at / i, pointers);
  }
}

std::vector<Pointer> pointers_in(const Json& document) {
  std::vector<Pointer> pointers;
  collect(document, Pointer(), pointers);
  return pointers;
}

Json full_document() {
  return Json::parse(kFullDocument);
}

TEST(SceneJson, ReadsEveryMember) {
  const Result<Scene> scene = read_scene_text(kFullDocument, full_meshes);
  ASSERT_EQ(lines(scene), "");
  EXPECT_EQ(bits_of(scene.value()), bits_of(full_scene()));
}

// The comparison by saved bytes covers every member.
TEST(SceneJson, SavedBytesHoldEveryMember) {
  const std::vector<std::uint8_t> bytes = bits_of(full_scene());
  LoadingArchive archive(bytes);
  Scene loaded;
  archive(loaded);
  for (Material& material : loaded.materials) archive(material.appearance);
  for (BodyDescription& body : loaded.bodies) archive(body.motion, body.axle, body.sub_steps);
  EXPECT_FALSE(archive.failed());
  EXPECT_EQ(write_scene(loaded), write_scene(full_scene()));
}

TEST(SceneJson, TheFullSceneRuns) {
  const Result<Simulation> simulation = Simulation::create(full_scene());
  ASSERT_EQ(lines(simulation), "");
  EXPECT_EQ(simulation.value().bodies().size(), 7U);
}

TEST(SceneJson, OnlyThreeMembersAreNeeded) {
  const Result<Scene> scene =
      read_scene_text(R"({"format": "vat.scene/1", "materials": [], "bodies": []})", no_meshes);
  ASSERT_EQ(lines(scene), "");
  EXPECT_EQ(bits_of(scene.value()), bits_of(Scene{}));
}

TEST(SceneJson, DefaultsOfTheParts) {
  const Result<Scene> read = read_scene_text(R"json({
    "format": "vat.scene/1",
    "materials": [{"name": "wood"}],
    "default_interface": {"stiffness": 7},
    "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "motion": {"type": "slide", "stroke": 0.5}},
    "numerics": {},
    "bodies": [
      {"name": "rod", "kind": "rigid", "material": "wood", "spacing": 0.1,
       "shape": {"type": "cylinder", "radius": 0.2, "height": 0.4}, "position": [0.5, 0.5, 0.5]}
    ]
  })json",
                                             no_meshes);
  ASSERT_EQ(lines(read), "");
  Scene expected;
  expected.materials.emplace_back().name = "wood";
  expected.default_interface = {7, 0};
  expected.vat = Vat{{0, 0, 0}, {1, 1, 1}, false, SlideMotion{Vec3::UnitX(), 0.5, 1}, {}};
  BodyDescription& rod = expected.bodies.emplace_back();
  rod.name = "rod";
  rod.kind = BodyKind::rigid;
  rod.material = "wood";
  rod.shape = CylinderShape{Vec3::Zero(), Vec3::UnitZ(), 0.2, 0.4};
  rod.spacing = 0.1;
  rod.position = {0.5, 0.5, 0.5};
  EXPECT_EQ(bits_of(read.value()), bits_of(expected));
}

TEST(SceneJson, EveryMemberIsInTheDocument) {
  std::ifstream file(VAT_SOURCE_DIR "/protocol/SCENE.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::set<std::string> members{"file", "scale"};  // a mesh has one of these members
  for (const Pointer& pointer : pointers_in(full_document())) {
    if (full_document()[pointer.parent_pointer()].is_object()) members.insert(pointer.back());
  }
  EXPECT_GT(members.size(), 40U);
  for (const std::string& member : members) {
    EXPECT_THAT(text, HasSubstr('`' + member + '`'));
  }
}

/// Members that a part of the full scene needs. All others are optional. "N" represents each of the
/// numbers in parentheses.
constexpr const char* kRequired = R"(
  /format /materials /bodies /default_interface/stiffness
  /vat/min /vat/max /vat/motion/type /vat/motion/stroke
  /periodic/axes /periodic/min /periodic/max /central_field/angular_frequency
  /settling/drag /settling/until
  /emitters/N/name(01) /emitters/N/body(01) /emitters/N/position(01) /emitters/N/speed(01)
  /emitters/N/most_particles(01) /drains/0/name /drains/0/min /drains/0/max
  /interfaces/N/materials(01234) /interfaces/N/stiffness(0123)
  /materials/N/name(012) /materials/0/liquid/stiffness /materials/0/liquid/viscosity
  /materials/0/liquid/support_radius /materials/1/springs/structural/stiffness
  /materials/1/springs/shear/stiffness /materials/1/springs/bend/stiffness
  /materials/1/self_contact/stiffness /materials/1/plasticity/yield_strain
  /bodies/N/name(0123456) /bodies/N/kind(0123456) /bodies/N/material(0123456)
  /bodies/N/shape(0123456) /bodies/N/shape/type(0123456) /bodies/N/spacing(012346)
  /bodies/6/shape/radius /bodies/6/motion/type /bodies/6/motion/stroke
  /bodies/0/velocity_field/waves/N/amplitude(01) /bodies/0/velocity_field/waves/N/wave_vector(01)
  /bodies/0/displacement_field/waves/0/amplitude /bodies/0/displacement_field/waves/0/wave_vector
  /bodies/0/shape/size /bodies/1/shape/radius /bodies/2/shape/radius /bodies/2/shape/height
  /bodies/2/melting/into /bodies/2/melting/at /bodies/3/shape/file
  /bodies/4/shape/vertices /bodies/4/shape/triangles /bodies/5/shape/positions
  /bodies/5/springs/N/particles(01) /bodies/5/springs/N/stiffness(01))";

std::set<std::string> required_members() {
  std::set<std::string> required;
  std::istringstream words(kRequired);
  for (std::string word; words >> word;) {
    const std::size_t list = word.find('(');
    if (list == std::string::npos) {
      required.insert(word);
      continue;
    }
    const std::size_t place = word.find("/N/") + 1;
    for (const char index : word.substr(list + 1, word.size() - list - 2)) {
      required.insert(word.substr(0, place) + index + word.substr(place + 1, list - place - 1));
    }
  }
  return required;
}

TEST(SceneJson, NamesEveryMissingMember) {
  const Json document = full_document();
  std::set<std::string> required;
  for (const Pointer& pointer : pointers_in(document)) {
    if (!document[pointer.parent_pointer()].is_object()) continue;
    if (pointer.back() == "law") continue;  // another law has other members
    Json damaged = document;
    damaged[pointer.parent_pointer()].erase(pointer.back());
    const Result<Scene> scene = read_scene(damaged, full_meshes);
    if (scene.ok()) continue;
    for (const Error& error : scene.errors()) {
      if (error.code != "missing") continue;
      EXPECT_EQ(error.path, pointer.to_string());
      EXPECT_EQ(scene.errors().size(), 1U) << lines(scene);
      required.insert(error.path);
    }
  }
  EXPECT_EQ(required, required_members());
}

TEST(SceneJson, NamesUnknownMembersWhereverTheyAre) {
  const Json document = full_document();
  std::vector<Pointer> objects{Pointer()};
  for (const Pointer& pointer : pointers_in(document)) {
    if (document[pointer].is_object()) objects.push_back(pointer);
  }
  ASSERT_GE(objects.size(), 30U);
  for (const Pointer& object : objects) {
    Json damaged = document;
    damaged[object]["not/known~"] = 1;
    const Result<Scene> scene = read_scene(damaged, full_meshes);
    EXPECT_EQ(lines(scene), "unknown_member " + object.to_string() + "/not~1known~0\n");
  }
}

/// Returns whether a value of this JSON type can replace `original`.
bool same_type(const Json& original, const Json& value) {
  return original.type() == value.type() || (original.is_number() && value.is_number());
}

TEST(SceneJson, RefusesEveryWrongTypeAtItsPlace) {
  const Json document = full_document();
  const std::vector<Json> others{nullptr, true, 5, "x", Json::array(), Json::object()};
  for (const Pointer& pointer : pointers_in(document)) {
    for (const Json& other : others) {
      if (same_type(document[pointer], other)) continue;
      Json damaged = document;
      damaged[pointer] = other;
      const Result<Scene> scene = read_scene(damaged, full_meshes);
      ASSERT_EQ(lines(scene), "wrong_type " + pointer.to_string() + '\n') << other;
      EXPECT_THAT(scene.errors()[0].message, StartsWith("must be"));
    }
  }
}

TEST(SceneJson, TheMessageNamesTheRange) {
  Json document = full_document();
  document["numerics"]["step"] = 5;
  const Result<Scene> scene = read_scene(document, full_meshes);
  ASSERT_EQ(lines(scene), "out_of_range /numerics/step\n");
  EXPECT_THAT(scene.errors()[0].message, HasSubstr("from 1e-07 to 0.1"));
}

TEST(SceneJson, KnowsEveryIntegrator) {
  for (int id = 0; id < 5; ++id) {
    const auto integrator = static_cast<IntegratorId>(id);
    Json document = full_document();
    document["numerics"]["integrator"] = to_string(integrator);
    document.erase("interfaces");  // not all interfaces support projection
    const Result<Scene> scene = read_scene(document, full_meshes);
    ASSERT_EQ(lines(scene), "");
    EXPECT_EQ(scene.value().numerics.integrator, integrator);
  }
}

TEST(SceneJson, RefusesConstantsThatALawDoesNotHave) {
  const std::pair<const char*, std::vector<const char*>> laws[] = {
      {"penalty", {"reach"}},
      {"lennard_jones", {"damping", "friction", "restitution"}},
      {"projection", {"stiffness", "damping", "reach"}},
      {"sph", {"stiffness", "damping", "friction", "restitution", "reach", "threshold"}}};
  for (const auto& [law, members] : laws) {
    for (const char* member : members) {
      Json document = full_document();
      document["pressure_solver"] = "tait";
      document["vat"].erase("walls");
      Json interface = {{"materials", {"water", "vat"}}, {"law", law}, {member, 0.5}};
      if (law != std::string("sph") && law != std::string("projection")) interface["stiffness"] = 1;
      document["interfaces"] = Json::array({interface});
      const Result<Scene> scene = read_scene(document, full_meshes);
      EXPECT_EQ(lines(scene), std::string("not_allowed /interfaces/0/") + member + '\n') << law;
    }
  }
}

TEST(SceneJson, RefusesOtherFormats) {
  for (const char* format : {"vat.scene/2", "vat.scene", ""}) {
    Json document = full_document();
    document["format"] = format;
    EXPECT_EQ(lines(read_scene(document, full_meshes)), "unknown_name /format\n");
  }
  EXPECT_EQ(lines(read_scene(Json(7), no_meshes)), "wrong_type \n");
}

TEST(SceneJson, MalformedTextHasOneError) {
  const std::string deep(100'000, '[');
  const std::pair<std::string, std::string> cases[]{
      {"", "parse_error \n"},
      {"{\"format\": \"vat.scene/1\"", "parse_error \n"},
      {deep, "too_deep \n"},
      {"{\"gravity\": [0, 0, 1e999]}", "parse_error \n"},
      {"{\"name\": \"\xc3\x28\"}", "parse_error \n"},
      {"{\"bodies\": [], \"bodies\": []}", "duplicate_key \n"},
      {std::string("\x7f\x45\x4c\x46\x02\x01\x00\xff", 8), "parse_error \n"},
      {std::string(kSceneLimits.bytes + 1, ' '), "too_large \n"}};
  for (const auto& [text, expected] : cases) {
    const Result<Scene> scene = read_scene_text(text, no_meshes);
    EXPECT_EQ(lines(scene), expected) << text.substr(0, 40);
    ASSERT_FALSE(scene.ok());
    EXPECT_GT(scene.errors()[0].message.size(), 10U);
  }
}

TEST(SceneJson, PartsOnTheirOwnAreReadAtTheirPath) {
  Json body = full_document()["bodies"][1];
  EXPECT_EQ(read_body(body, "/body", no_meshes).value().name, "ball");
  body["shape"]["radius"] = -1;
  EXPECT_EQ(lines(read_body(body, "/body", no_meshes)), "out_of_range /body/shape/radius\n");
  Json interface = full_document()["interfaces"][0];
  EXPECT_EQ(read_interface(interface, "/interface").value().constants.stiffness, 2000.5);
  interface["materials"] = {"water"};
  EXPECT_EQ(lines(read_interface(interface, "/interface")), "out_of_range /interface/materials\n");
}

}  // namespace
}  // namespace vat::scene_json_test
