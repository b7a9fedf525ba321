#include "server/session/pointer_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/server/session_fixture.h"

namespace vat::test::pointer_commands_test {
namespace {

const MethodRules* rules_of(std::string_view method) {
  return &*std::ranges::find(method_rules(), method, &MethodRules::method);
}

class PointerCommandsTest : public testing::Test {
 protected:
  void add(ParticipantNumber participant, std::string_view method, const Json& params) {
    pointers.add(participant, {rules_of(method), params, {}}, Caller(outbox, {}));
  }
  /// "PARTICIPANT PARAMS CALLERS" of each that has waited.
  std::vector<std::string> take() {
    std::vector<std::string> taken;
    for (const auto& newest : pointers.take()) {
      taken.push_back(std::to_string(newest.participant) + " " + newest.command.params.dump() +
                      " " + std::to_string(newest.callers.size()));
    }
    return taken;
  }
  const std::shared_ptr<ClientOutbox> outbox =
      std::make_shared<ClientOutbox>(std::make_shared<FakeConnection>(1));
  PointerCommands pointers;
};

TEST_F(PointerCommandsTest, TheNewestOfOneParticipantAboutOneThingCountsForAll) {
  add(1, "grab.move", {{"grab", 5}, {"to", 1}});
  add(1, "grab.move", {{"grab", 6}, {"to", 2}});
  add(2, "grab.move", {{"grab", 5}, {"to", 3}});
  add(1, "grab.move", {{"grab", 5}, {"to", 4}});
  add(1, "grab.move", {{"grab", 5}, {"to", 5}});
  EXPECT_THAT(take(), testing::ElementsAre(R"(1 {"grab":6,"to":2} 1)", R"(2 {"grab":5,"to":3} 1)",
                                           R"(1 {"grab":5,"to":5} 3)"));
  EXPECT_TRUE(pointers.empty());
}

TEST_F(PointerCommandsTest, WhoCameLastIsCarriedOutLast) {
  add(1, "world.set_gravity", {{"to", 1}});
  add(2, "world.set_gravity", {{"to", 2}});
  add(1, "world.set_gravity", {{"to", 3}});
  EXPECT_THAT(take(), testing::ElementsAre(R"(2 {"to":2} 1)", R"(1 {"to":3} 2)"));
}

TEST_F(PointerCommandsTest, TellsWhoseWait) {
  add(2, "world.set_gravity", {{"to", 1}});
  EXPECT_TRUE(pointers.has_of(2));
  EXPECT_FALSE(pointers.has_of(1));
}

// At a twentieth of the speed a tick takes 0.4 s: all of these fall between two.
TEST_F(SessionTest, CommandsThatFollowAPointerWaitForTheNextTickAndAreAnsweredWithIt) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.play");
  client->result("frames.subscribe");
  const std::uint64_t before =
      client->wait_frame([](const GridFrame& frame) { return frame.header.tick > 0; }).header.tick;
  std::vector<int> ids;
  for (int i = 1; i <= 5; ++i) {
    ids.push_back(client->send("world.set_gravity", {{"gravity", {0, 0, -i}}}));
  }
  std::vector<std::uint64_t> ticks;
  for (const int id : ids) ticks.push_back(client->wait_reply(id).at("result").at("tick"));
  EXPECT_THAT(ticks, testing::Each(ticks.front()));
  EXPECT_EQ(ticks.front(), before);
  const Json description = client->wait_event("session.description", [](const Json& d) {
    return d.at("gravity") != Json({0, 0, -9.81});
  });
  EXPECT_EQ(description.at("gravity"), Json({0, 0, -5}))
      << "one of those before it was carried out";
}

TEST_F(SessionTest, AQuestionOfTheSameClientIsAnsweredAfterWhatItSentBefore) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.play");
  const std::string before = hash();
  const int gravity = client->send("world.set_gravity", {{"gravity", {0, 0, -1}}});
  const Json answer = client->result("session.hash");
  EXPECT_NE(answer.at("hash"), before);
  EXPECT_EQ(client->wait_reply(gravity).at("result").at("tick"), answer.at("tick"));
}

}  // namespace
}  // namespace vat::test::pointer_commands_test
