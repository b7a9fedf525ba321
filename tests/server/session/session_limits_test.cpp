// Limits of the number and the rate of client requests, at the limit and beyond.

#include "core/limits.h"
#include "core/validation/validate.h"
#include "tests/server/fixture/host.h"

namespace vat::test::session_limits_test {
namespace {

ServerLimits limits_for(std::size_t mixed_scenes) {
  ServerLimits limits;
  limits.max_particles_in_all = mixed_scenes * mixed_simulation().greatest_particle_count();
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
};

// A burst passes. The next message is refused and changes nothing. After the time in the refusal, a
// message passes.
TEST_F(SessionLimits, MessagesOfAClassComeSoOften) {
  const auto other = join();
  Json refusal;
  int passed = 0;
  for (; passed < 100 && refusal.is_null(); ++passed) {
    const Json reply = other->call("session.hash");
    if (reply.contains("error")) refusal = reply.at("error");
  }
  EXPECT_EQ(passed, 1 + 40) << "a burst of two seconds, and the refusal";
  ASSERT_FALSE(refusal.is_null());
  EXPECT_EQ(refusal.at("code"), 1009);
  EXPECT_EQ(refusal.at("data").at("kind"), "rate_limited");
  EXPECT_EQ(refusal.at("data").at("limit"), "queries_per_second");
  EXPECT_EQ(refusal.at("data").at("maximum"), 20);
  const double retry_after = refusal.at("data").at("retry_after");
  EXPECT_GT(retry_after, 0);
  EXPECT_LE(retry_after, 1.0 / 20);
  other->result("control.pause");  // message of another class
  client->result("session.hash");  // message of another connection
  const auto seconds = [](double s) {
    return std::chrono::ceil<SteadyClock::duration>(std::chrono::duration<double>(s));
  };
  server.clock().advance(seconds(0.9 * retry_after));
  EXPECT_TRUE(other->call("session.hash").contains("error"));
  server.clock().advance(seconds(0.1 * retry_after));
  other->result("session.hash");
  EXPECT_TRUE(
      has_sample(server.metrics(), R"(vat_rate_limited_total{limit="queries_per_second"} 2)"));
}

TEST_F(SessionLimits, AControlThatIsRefusedChangesNothing) {
  const auto other = join();
  std::uint64_t steps = 0;
  for (int i = 0; i < 60; ++i) steps += other->call("control.step").contains("result") ? 1 : 0;
  EXPECT_EQ(steps, 20U - 1) << "a burst of two seconds, including the join";
  EXPECT_EQ(tick(), steps);
}

TEST_F(SessionLimits, AFloodOfMessagesIsLimited) {
  for (const char* text : {"", "{}", "[]", R"({"jsonrpc":"2.0","method":"no.such"})", "\xff",
                           R"({"jsonrpc":"2.0","method":"session.hash"})"}) {
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

TEST_F(SessionLimits, ACreationThatFailsHasTakenNothing) {
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(
        client->error("session.create", {{"name", "n"}, {"scene", "none"}}).at("data").at("kind"),
        "no_such_scene");
  }
  client->create_session();
}

class SharedBudget : public SessionLimits {
 protected:
  SharedBudget() : SessionLimits(2) {}
};

TEST_F(SharedBudget, ParticlesOfAllSessions) {
  client->create_session();
  const std::string before = hash();
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  Json body = Json::parse(mixed_scene_text()).at("bodies").at(2);
  body["name"] = "another";
  body["position"] = {0.3, 0.7, 0.7};
  expect_limit(client->error("world.add_body", {{"body", body}}), "particles_in_all");
  EXPECT_EQ(hash(), before);
  client->result("scene.load", {{"scene", "mixed"}});  // replaces the same number of particles
  client->result("session.close", {{"session", "s2"}});
  client->result("world.add_body", {{"body", body}});
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  client->result("control.reset");
  client->create_session();
}

// A session reserves the particles of its scene, even if bodies are removed.
TEST_F(SharedBudget, ARemovedBodyLeavesRoomForAReset) {
  client->result("world.remove_body", {{"body", 1}});
  client->create_session();
  expect_limit(client->error("session.create", {{"name", "n"}, {"scene", "mixed"}}),
               "particles_in_all");
  client->result("control.reset");
}

// Exact limits: a message at the limit passes, and one beyond is refused.

/// Returns a request as text with a given number of bytes.
std::string request(std::string_view id, std::string_view method, std::size_t bytes,
                    const Json& params = Json::object()) {
  const Json message{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}};
  std::string text = message.dump();
  text.resize(bytes, ' ');
  return text;
}

class MessageLimits : public SessionTest {
 protected:
  static ServerLimits limits() {
    ServerLimits limits = unhurried_limits();
    limits.max_message_bytes = 2000;
    limits.max_scene_message_bytes = 3000;
    limits.max_message_depth = 20;
    limits.max_message_values = 1000;
    limits.max_bytes_in_flight = 2500;
    return limits;
  }
  MessageLimits() : SessionTest(limits()) {}

  /// Returns the next reply with this id or with null.
  Json answer(const std::string& text, const Json& id) {
    const std::size_t from = client->connection->texts().size();
    client->send_raw(text, id.is_null());
    return client->connection->wait_text(
        [&](const Json& reply) { return reply.contains("id") && reply.at("id") == id; }, from);
  }
  /// Returns the error data of a text that is not a request.
  Json fault(const std::string& text) { return answer(text, nullptr).at("error").at("data"); }
};

TEST_F(MessageLimits, BytesOfAMessage) {
  EXPECT_TRUE(answer(request("a", "server.info", 2000), "a").contains("result"));
  const Json longer = answer(request("b", "server.info", 2001), "b").at("error").at("data");
  EXPECT_EQ(longer.at("limit"), "message_bytes");
  EXPECT_EQ(longer.at("maximum"), 2000);
  const Json scene = {{"scene", "mixed"}};
  EXPECT_TRUE(answer(request("c", "scene.load", 2500, scene), "c").contains("result"));
  const Json too_long = fault(request("d", "scene.load", 3001, scene));
  EXPECT_EQ(too_long.at("limit"), "scene_message_bytes");
  EXPECT_EQ(too_long.at("maximum"), 3000);
}

// Nested lists and a list of numbers are read as batches. Batches are refused.
TEST_F(MessageLimits, DepthAndValuesOfAMessage) {
  EXPECT_EQ(fault(std::string(20, '[') + std::string(20, ']')).at("kind"), "invalid_request");
  EXPECT_EQ(fault(std::string(21, '[') + std::string(21, ']')).at("reason"), "too_deep");
  std::string values = "[1";
  for (int i = 2; i < 1000; ++i) values += ",1";
  EXPECT_EQ(fault(values + ']').at("kind"), "invalid_request");
  EXPECT_EQ(fault(values + ",1]").at("reason"), "too_many_values");
}

TEST_F(MessageLimits, BytesInFlight) {
  const std::string step = request("step", "control.step", 2000, {{"ticks", 1000}});
  client->send_raw(step);
  client->send_raw(request("fits", "session.hash", 500));
  const Json data = answer(request("more", "session.hash", 80), "more").at("error").at("data");
  EXPECT_EQ(data.at("limit"), "command_bytes_in_flight");
  EXPECT_EQ(data.at("maximum"), 2500);
  join()->result("control.pause");  // ends the step
  for (const char* id : {"step", "fits"}) {
    EXPECT_TRUE(client->wait_reply(id).contains("result")) << id;
  }
  EXPECT_TRUE(answer(request("then", "session.hash", 2000), "then").contains("result"));
}

struct SceneLimit {
  const char* name;
  std::size_t ServerLimits::*value;
  std::size_t needed;
};

TEST(SceneLimits, HoldForStepsOfARunningSession) {
  const Simulation simulation = mixed_simulation();
  const Catalogue catalogue = make_catalogue();
  Host host(catalogue, "",
            limits_with(&ServerLimits::max_particle_steps_per_tick,
                        simulation.greatest_particle_count() * simulation.steps_per_tick()));
  TestClient& client = *host.client;
  const Json before = client.result("session.hash");
  const Json error = client.error("world.set_numerics", {{"step", 0.001}});
  EXPECT_EQ(error.at("data").at("limit"), "particle_steps_per_tick");
  EXPECT_EQ(client.result("session.hash"), before);
  client.result("world.set_numerics", {{"step", 0.0025}});
  client.result("world.set_numerics", {{"step", 0.002}});
}

// The scene needs exactly the limit.
TEST(SceneLimits, HoldAtTheirValueAndNotBeyond) {
  const Scene scene = to_scene(mixed_scene_text());
  const Simulation simulation = Simulation::create(scene).value();
  const std::size_t particles = simulation.greatest_particle_count();
  const std::size_t springs = simulation.spring_count();
  const Catalogue catalogue = make_catalogue();
  for (const auto& [name, value, needed] :
       {SceneLimit{"particles", &ServerLimits::max_particles, particles},
        SceneLimit{"springs", &ServerLimits::max_springs, springs},
        SceneLimit{"particles_in_all", &ServerLimits::max_particles_in_all, particles},
        SceneLimit{"springs_in_all", &ServerLimits::max_springs_in_all, springs},
        SceneLimit{"particle_steps_per_tick", &ServerLimits::max_particle_steps_per_tick,
                   particles * simulation.steps_per_tick()}}) {
    ServerSettings settings;
    settings.limits.*value = needed;
    EXPECT_TRUE(TestServer(catalogue, settings).create_session("n", scene).ok()) << name;
    settings.limits.*value = needed - 1;
    const auto refused = TestServer(catalogue, settings).create_session("n", scene);
    ASSERT_FALSE(refused.ok()) << name;
    EXPECT_EQ(refused.errors().front().message,
              "at most " + std::to_string(needed - 1) + ' ' + name);
  }
}

Scene scene_of_bodies(std::size_t count) {
  Scene scene = to_scene(mixed_scene_text());
  const auto ball = scene.bodies.back();
  scene.bodies.clear();
  for (std::size_t i = 0; i < count; ++i) {
    scene.bodies.push_back(ball);
    scene.bodies.back().name = "ball " + std::to_string(i);
  }
  return scene;
}

TEST(FixedLimits, BodiesOfAScene) {
  const auto is_refused = [](const Errors& errors) {
    return std::ranges::any_of(errors, [](const Error& error) {
      return error.message == "at most " + std::to_string(kMaxBodies) + " bodies";
    });
  };
  EXPECT_FALSE(is_refused(find_errors(scene_of_bodies(kMaxBodies))));
  EXPECT_TRUE(is_refused(find_errors(scene_of_bodies(kMaxBodies + 1))));
  const BodyDescription another = scene_of_bodies(1).bodies[0];
  EXPECT_FALSE(is_refused(find_body_errors(scene_of_bodies(kMaxBodies - 1), another, "/body")));
  EXPECT_TRUE(is_refused(find_body_errors(scene_of_bodies(kMaxBodies), another, "/body")));
}

}  // namespace
}  // namespace vat::test::session_limits_test
