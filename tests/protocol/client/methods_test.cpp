#include "protocol/client/methods/methods.h"

#include <gtest/gtest.h>

#include "protocol/client/methods/invalid_value.h"

namespace vat::client::methods_test {
namespace {

template <class Params>
Json write(const Params& params) {
  Json json;
  write_json(json, params);
  return json;
}

template <class Value>
std::string fault_of(const Json& json) {
  Value value;
  try {
    read_json(json, value);
  } catch (const InvalidValue& error) {
    return error.what();
  }
  return "";
}

TEST(ClientMethods, WriteOnlyTheGivenMembers) {
  EXPECT_EQ(write(Nothing{}), Json::object());
  EXPECT_EQ(write(ControlStep::Params{}), Json::object());
  EXPECT_EQ(write(ControlStep::Params{.ticks = 25}), Json({{"ticks", 25}}));
  EXPECT_EQ(write(SessionCreate::Params{.name = "a", .scene = "dam-break", .level = Level::fine}),
            Json({{"name", "a"}, {"scene", "dam-break"}, {"level", "fine"}}));
  EXPECT_EQ(write(GrabStart::Params{.body = "ball", .particle = 3, .target = Vec3(1, 2, 3)}),
            Json({{"body", "ball"}, {"particle", 3}, {"target", {1, 2, 3}}}));
}

TEST(ClientMethods, WriteNestedObjects) {
  const FramesSubscribe::Params params{
      .max_error = 0.001,
      .region = FramesSubscribe::Params::Region{.min = Vec3(0, 0, 0), .max = Vec3(1, 1, 1)},
      .attributes = FramesSubscribe::Params::Attributes{.speed = 0.01}};
  EXPECT_EQ(write(params), Json({{"max_error", 0.001},
                                 {"region", {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}}},
                                 {"attributes", {{"speed", 0.01}}}}));
}

TEST(ClientMethods, AnUnknownEnumeratorCannotBeSent) {
  EXPECT_THROW(write(SessionJoin::Params{.role = Role::unknown}), std::invalid_argument);
}

TEST(ClientMethods, ReadLists) {
  const Json json = {{"tick", 9},
                     {"time", 0.5},
                     {"bodies",
                      {{{"body", 2},
                        {"name", "ball"},
                        {"kind", "rigid"},
                        {"velocities", {{0, 0, 1}}},
                        {"positions", {{1, 2, 3}}},
                        {"orientation", {1, 0, 0, 0}}}}}};
  StateQuery::Result result;
  read_json(json, result);
  EXPECT_EQ(result.tick, 9U);
  ASSERT_EQ(result.bodies.size(), 1U);
  EXPECT_EQ(result.bodies[0].kind, BodyKind::rigid);
  EXPECT_EQ(result.bodies[0].positions.at(0), Vec3(1, 2, 3));
  EXPECT_EQ(result.bodies[0].orientation->at(0), 1);
  EXPECT_FALSE(result.bodies[0].numbers);
}

TEST(ClientMethods, IgnoreMembersAndEnumeratorsOfLaterVersions) {
  const Json json = {{"role", "spectator"}, {"colour", "red"}};
  AccessEnter::Result result;
  read_json(json, result);
  EXPECT_EQ(result.role, Role::unknown);
}

TEST(ClientMethods, NameTheInvalidMember) {
  EXPECT_EQ(fault_of<InEffect>({{"tick", -1}}), "/tick is outside the range of its type");
  EXPECT_EQ(fault_of<InEffect>({{"tick", 1.5}}), "/tick is not an integer");
  EXPECT_EQ(fault_of<InEffect>(Json::object()), "/tick is missing");
  EXPECT_EQ(fault_of<InEffect>(7), "the value is not an object");
  EXPECT_EQ(fault_of<WorldAddBody::Result>({{"tick", 1}, {"body", 4294967296}}),
            "/body is outside the range of its type");
  EXPECT_EQ(fault_of<WorldAddBody::Result>({{"tick", 1}, {"body", 4294967295}}), "");
  const Json bodies = {{{"body", 1},
                        {"name", "ball"},
                        {"kind", "rigid"},
                        {"velocities", Json::array()},
                        {"positions", {{1, 2}}}}};
  EXPECT_EQ(fault_of<StateQuery::Result>({{"tick", 1}, {"time", 0}, {"bodies", bodies}}),
            "/bodies/0/positions/0 needs 3 numbers");
}

}  // namespace
}  // namespace vat::client::methods_test
