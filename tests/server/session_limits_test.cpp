// Limits of what clients may ask for together, and how often, at and beyond.

#include <atomic>
#include <thread>

#include "tests/server/session_fixture.h"

namespace vat::test::session_limits_test {
namespace {

Simulation mixed() {
  return Simulation::create(to_scene(mixed_scene_text())).value();
}

ServerLimits limits_for(std::size_t mixed_scenes) {
  ServerLimits limits;
  limits.max_particles_in_all = mixed_scenes * mixed().greatest_particle_count();
  limits.max_sessions_per_address = 3;
  limits.max_queries_per_second = 20;
  limits.max_controls_per_second = 10;
  limits.max_pointer_moves_per_second = 15;
  limits.max_scenes_per_second = 5;
  limits.burst_seconds = 2;
  limits.max_refusals_per_second = 50;
  return limits;
}

class SessionLimits : public SessionTest {
 protected:
  explicit SessionLimits(std::size_t mixed_scenes = 100) : SessionTest(limits_for(mixed_scenes)) {}

  static void expect_limit(const Json& error, const std::string& limit) {
    EXPECT_EQ(error.at("data").at("kind"), "limit_reached") << error;
    EXPECT_EQ(error.at("data").at("limit"), limit) << error;
  }
  bool metrics_have(const std::string& line) {
    return server.metrics().find(line + '\n') != std::string::npos;
  }
};

// A burst passes, the next is refused and changes nothing, and after the time that the refusal
// names the next one passes.
TEST_F(SessionLimits, MessagesOfAClassComeSoOften) {
  const auto other = join();
  Json refusal;
  int passed = 0;
  for (; passed < 100 && refusal.is_null(); ++passed) {
    const Json reply = other->call("session.hash");
    if (reply.contains("error")) refusal = reply.at("error");
  }
  EXPECT_GE(passed, 40);
  ASSERT_FALSE(refusal.is_null());
  EXPECT_EQ(refusal.at("code"), 1009);
  EXPECT_EQ(refusal.at("data").at("kind"), "rate_limited");
  EXPECT_EQ(refusal.at("data").at("limit"), "queries_per_second");
  EXPECT_EQ(refusal.at("data").at("maximum"), 20);
  const double retry_after = refusal.at("data").at("retry_after");
  EXPECT_GT(retry_after, 0);
  EXPECT_LE(retry_after, 1.0 / 20);
  other->result("control.pause");  // of another class
  std::this_thread::sleep_for(std::chrono::duration<double>(retry_after));
  other->result("session.hash");
  EXPECT_TRUE(metrics_have(R"(vat_rate_limited_total{limit="queries_per_second"} 1)"));
}

TEST_F(SessionLimits, AControlThatIsRefusedChangesNothing) {
  const auto other = join();
  std::uint64_t steps = 0;
  for (int i = 0; i < 60; ++i) steps += other->call("control.step").contains("result") ? 1 : 0;
  EXPECT_LT(steps, 60U);
  EXPECT_EQ(tick(), steps);
}

TEST_F(SessionLimits, LimitsAreThoseOfAConnectionAndNotOfOthers) {
  const auto other = join();
  while (!other->call("session.hash").contains("error")) {
  }
  client->result("session.hash");
}

TEST_F(SessionLimits, WhoGoesOnRegardlessIsClosed) {
  const auto other = join();
  int sent = 0;
  for (; sent < 10'000 && !other->connection->close_code(); ++sent) other->notify("session.hash");
  EXPECT_EQ(other->connection->close_code(), 4009);
  EXPECT_GT(sent, 40 + 100) << "a burst, and a burst of refusals";
  client->result("session.hash");
}

TEST_F(SessionLimits, AFloodOfWhatIsNoRequestIsOneToo) {
  for (const char* text : {"", "{}", "[]", R"({"jsonrpc":"2.0","method":"no.such"})", "\xff"}) {
    const auto other = connect();
    for (int i = 0; i < 10'000 && !other->connection->close_code(); ++i)
      other->send_raw(text, true);
    EXPECT_EQ(other->connection->close_code(), 4009) << text;
    EXPECT_LT(other->connection->texts().size(), 300U) << "answers are limited too";
  }
  const auto binary = connect();
  for (int i = 0; i < 10'000 && !binary->connection->close_code(); ++i) {
    server.binary_received(binary->connection->id(), "x");
  }
  EXPECT_EQ(binary->connection->close_code(), 4009);
}

TEST_F(SessionLimits, SessionsOfAnAddress) {
  for (int i = 0; i < 3; ++i) {
    client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  }
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "sessions_per_address");
  EXPECT_TRUE(metrics_have(R"(vat_refused_total{limit="sessions_per_address"} 1)"));
  const auto elsewhere = connect_from("10.0.0.7");
  elsewhere->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  client->result("session.close", {{"session", "s2"}});
  client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
}

TEST_F(SessionLimits, ACreationThatFailsHasTakenNothing) {
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(
        client->error("session.create", {{"name", "n"}, {"scene", "none"}}).at("data").at("kind"),
        "no_such_scene");
  }
  client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
}

class SharedBudget : public SessionLimits {
 protected:
  SharedBudget() : SessionLimits(2) {}
};

TEST_F(SharedBudget, ParticlesOfAllSessions) {
  client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  const std::string before = hash();
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  Json body = Json::parse(mixed_scene_text()).at("bodies").at(2);
  body["name"] = "another";
  body["position"] = {0.3, 0.7, 0.7};
  expect_limit(client->error("world.add_body", {{"body", body}}), "particles_in_all");
  EXPECT_EQ(hash(), before);
  client->result("scene.load", {{"scene", "mixed"}});  // in place of as many
  client->result("session.close", {{"session", "s2"}});
  client->result("world.add_body", {{"body", body}});
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  client->result("control.reset");
  client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
}

// What a session may go back to stays its own.
TEST_F(SharedBudget, ARemovedBodyLeavesRoomForAReset) {
  client->result("world.remove_body", {{"body", 1}});
  client->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  client->result("control.reset");
}

TEST_F(SharedBudget, WhatFitsOnceIsCreatedOnceHoweverManyAskAtOnce) {
  const Scene scene = to_scene(mixed_scene_text());
  std::atomic<int> created = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] { created += server.create_session("n", scene) ? 1 : 0; });
    }
  }
  EXPECT_EQ(created, 1);
}

class FewSprings : public SessionTest {
 protected:
  static ServerLimits few_springs() {
    ServerLimits limits;
    limits.max_springs = mixed().spring_count();
    return limits;
  }
  FewSprings() : SessionTest(few_springs()) {}
};

TEST_F(FewSprings, SpringsOfASession) {
  Json scene = Json::parse(mixed_scene_text());
  client->result("scene.load", {{"scene", scene}});
  scene["bodies"][1]["shape"]["size"] = {0.3, 0.2, 0.2};
  const Json error = client->error("scene.load", {{"scene", scene}});
  EXPECT_EQ(error.at("data").at("limit"), "springs");
  EXPECT_EQ(error.at("data").at("maximum"), mixed().spring_count());
}

}  // namespace
}  // namespace vat::test::session_limits_test
