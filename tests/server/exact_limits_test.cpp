// Limits to the unit: what has just the value passes, one more does not.

#include "core/limits.h"
#include "core/scene/validate.h"
#include "server/http/downloads.h"
#include "tests/server/session_fixture.h"

namespace vat::test::exact_limits_test {
namespace {

/// A request as text, with so many bytes.
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
    ServerLimits limits = unhurried();
    limits.max_message_bytes = 2000;
    limits.max_scene_message_bytes = 3000;
    limits.max_message_depth = 20;
    limits.max_message_values = 1000;
    limits.max_bytes_in_flight = 2500;
    return limits;
  }
  MessageLimits() : SessionTest(limits()) {}

  /// The next reply to this id, or to null.
  Json answer(const std::string& text, const Json& id) {
    const std::size_t from = client->connection->texts().size();
    client->send_raw(text, id.is_null());
    return client->connection->wait_text(
        [&](const Json& reply) { return reply.contains("id") && reply.at("id") == id; }, from);
  }
  /// What is wrong with a text that is no request.
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

// Lists within each other, and a list of ones, are read as batches, which are refused.
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

// A session of the scene, of which one needs just as much.
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
    EXPECT_TRUE(SessionServer(catalogue, settings).create_session("n", scene).ok()) << name;
    settings.limits.*value = needed - 1;
    const auto refused = SessionServer(catalogue, settings).create_session("n", scene);
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
}

class NameAndTickLimits : public SessionTest {};

TEST_F(NameAndTickLimits, HoldAtTheirValueAndNotBeyond) {
  const auto path = [](const Json& error) { return error.at("data").at("path"); };
  const std::string longest(kMaxNameLength, 'n');
  client->result("session.create", {{"name", longest}, {"scene", "mixed"}});
  EXPECT_EQ(path(client->error("session.create", {{"name", longest + 'n'}, {"scene", "mixed"}})),
            "/name");
  client->result("control.step", {{"ticks", kMaxTicksPerStep}});
  EXPECT_EQ(path(client->error("control.step", {{"ticks", kMaxTicksPerStep + 1}})), "/ticks");
}

TEST(Downloads, AreBounded) {
  Downloads downloads(10);
  const Downloads::Clock::time_point now{};
  const auto first = downloads.add({"a", "123456"}, now);
  EXPECT_TRUE(first.has_value());
  EXPECT_FALSE(downloads.add({"b", "12345"}, now).has_value());
  EXPECT_TRUE(downloads.add({"c", "1234"}, now).has_value());
  EXPECT_FALSE(downloads.add({"d", "1"}, now).has_value());
  downloads.take(*first, now);
  EXPECT_TRUE(downloads.add({"e", "123456"}, now).has_value());
}

}  // namespace
}  // namespace vat::test::exact_limits_test
