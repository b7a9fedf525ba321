#include "tests/server/session_fixture.h"

#include <utility>

#include "core/simulation/simulation.h"
#include "server/messages/describe.h"
#include "tests/server/message_record.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {
namespace {

Json make_request(std::string_view method, const Json& params) {
  Json request{{"jsonrpc", "2.0"}, {"method", method}};
  if (!params.is_null()) request["params"] = params;
  return request;
}

}  // namespace

const std::string& mixed_scene_text() {
  static const std::string kText = R"({
    "format": "vat.scene/1", "name": "mixed", "title": "Mixed", "description": "All kinds",
    "materials": [
      {"name": "water", "density": 1000,
       "liquid": {"stiffness": 50, "viscosity": 1, "support_radius": 0.2}},
      {"name": "rubber", "density": 500, "springs": {"structural": {"stiffness": 500, "damping": 1}}},
      {"name": "wood", "density": 600}],
    "default_interface": {"stiffness": 1000, "damping": 1},
    "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "lid": true},
    "numerics": {"integrator": "velocity_verlet", "step": 0.002, "tick": 0.02},
    "bodies": [
      {"name": "pool", "kind": "liquid", "material": "water", "spacing": 0.1,
       "shape": {"type": "box", "center": [0.5, 0.5, 0.2], "size": [0.5, 0.5, 0.3]}},
      {"name": "cube", "kind": "deformable", "material": "rubber", "spacing": 0.1,
       "shape": {"type": "box", "center": [0.3, 0.3, 0.6], "size": [0.2, 0.2, 0.2]}},
      {"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.1,
       "shape": {"type": "sphere", "radius": 0.15}, "position": [0.7, 0.7, 0.7]}]})";
  return kText;
}

const std::string& unstable_scene_text() {
  static const std::string kText = R"({
    "format": "vat.scene/1", "name": "unstable", "title": "Unstable",
    "materials": [{"name": "steel", "density": 1000}],
    "numerics": {"integrator": "explicit_euler", "step": 0.1, "tick": 0.1},
    "bodies": [
      {"name": "pair", "kind": "deformable", "material": "steel", "radius": 0.1,
       "shape": {"type": "particles", "positions": [[0, 0, 0], [1, 0, 0]], "masses": [1, 1]},
       "springs": [{"particles": [0, 1], "stiffness": 1e9, "damping": 0, "rest_length": 0.5}]}]})";
  return kText;
}

Catalogue make_catalogue() {
  const TemporaryFolder folder;
  folder.write("mixed.json", mixed_scene_text());
  folder.write("unstable.json", unstable_scene_text());
  Result<Catalogue> catalogue = Catalogue::open(folder.path().string());
  return std::move(catalogue).value();
}

Scene to_scene(const std::string& text) {
  const auto no_meshes = [](const std::string&) -> Result<std::string> {
    return Error{"no_mesh", "", "there are no meshes"};
  };
  return read_scene_text(text, no_meshes).value();
}

ServerLimits unhurried_limits() {
  ServerLimits limits;
  limits.burst_seconds = 1e9;
  return limits;
}

ServerSettings test_settings(const ServerLimits& limits, const std::string& data_folder) {
  ServerSettings settings;
  settings.limits = limits;
  settings.version = "1.2.3";
  settings.threads = 2;
  settings.data_folder = data_folder;
  settings.access.refusal_delay = std::chrono::milliseconds(0);
  settings.access.admin = hash_of_token(kAdminToken);
  return settings;
}

TestServer::TestServer(const Catalogue& catalogue, ServerSettings settings)
    : SessionServer(catalogue, std::move(settings), own_clock), clock_(&own_clock) {}

TestServer::TestServer(const Catalogue& catalogue, ServerSettings settings, ManualClock& clock)
    : SessionServer(catalogue, std::move(settings), clock), clock_(&clock) {}

void TestServer::advance_until(const std::function<bool()>& condition) {
  constexpr auto kMaxTime = std::chrono::minutes(1);
  const auto end = clock_->now() + kMaxTime;
  for (flush(); !condition(); flush()) {
    if (clock_->now() > end) throw std::runtime_error("an expected event did not come");
    clock_->advance_to_next();
  }
}

TestClient::TestClient(TestServer& server, ConnectionId id, std::string address)
    : connection(std::make_shared<FakeConnection>(id, std::move(address))), server_(server) {
  connection->record(message_record());
  server_.opened(connection);
}

void TestClient::send_raw(std::string_view text, bool wrong) {
  if (auto* record = message_record()) record->sent(std::to_string(connection->id()), text, wrong);
  server_.text_received(connection->id(), text);
}

void TestClient::disconnect() {
  if (std::exchange(connected_, false)) server_.closed(connection->id());
}

int TestClient::send(std::string_view method, const Json& params) {
  Json request = make_request(method, params);
  request["id"] = ++last_id_;
  send_raw(request.dump());
  return last_id_;
}

void TestClient::notify(std::string_view method, const Json& params) {
  send_raw(make_request(method, params).dump());
}

void TestClient::notify_wrong(std::string_view method, const Json& params) {
  send_raw(make_request(method, params).dump(), true);
}

Json TestClient::wait_reply(const Json& id) {
  return connection->wait_text(
      [&id](const Json& text) { return text.contains("id") && text.at("id") == id; });
}

Json TestClient::call(std::string_view method, const Json& params) {
  return wait_reply(send(method, params));
}

Json TestClient::result(std::string_view method, const Json& params) {
  const Json reply = call(method, params);
  EXPECT_TRUE(reply.contains("result")) << method << " " << params << ": " << reply;
  return reply.value("result", Json());
}

Json TestClient::wait_reply_at_tick(int id) {
  const auto is_reply = [id](const Json& text) { return text.value("id", Json()) == id; };
  std::optional<Json> reply;
  server_.advance_until([&] {
    reply = connection->find_text(is_reply);
    return reply.has_value();
  });
  return *reply;
}

Json TestClient::error(std::string_view method, const Json& params) {
  const Json reply = call(method, params);
  EXPECT_TRUE(reply.contains("error")) << method << " " << params << ": " << reply;
  return reply.value("error", Json());
}

std::uint64_t TestClient::grab(BodyId body) {
  return result("grab.start", {{"body", body}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}})
      .at("grab");
}

Json TestClient::wait_event(std::string_view event, const std::function<bool(const Json&)>& fits) {
  const auto fits_text = [&](const Json& text) {
    return text.value("method", "") == event && (!fits || fits(text.at("params")));
  };
  std::optional<Json> found;
  server_.advance_until([&] {
    found = connection->find_text(fits_text, mark_);
    return found.has_value();
  });
  return found->at("params");
}

GridFrame TestClient::wait_frame(const std::function<bool(const GridFrame&)>& fits) {
  for (;; ++seen_frames_) {
    server_.advance_until([&] { return connection->frame_count() > seen_frames_; });
    const GridFrame frame = connection->frame(seen_frames_);
    notify("frames.ack", {{"number", frame.header.number}});
    if (fits(frame)) return frame;
  }
}

void TestClient::wait_closed() {
  server_.advance_until([&] { return connection->close_code().has_value(); });
}

std::vector<Json> TestClient::events(std::string_view event) const {
  const std::vector<Json> texts = connection->texts();
  std::vector<Json> params;
  for (std::size_t i = mark_; i < texts.size(); ++i) {
    if (texts[i].value("method", "") == event) params.push_back(texts[i].at("params"));
  }
  return params;
}

SessionTest::SessionTest(const ServerLimits& limits)
    : catalogue(make_catalogue()), server(catalogue, test_settings(limits)) {
  if (!server.create_session("first", to_scene(mixed_scene_text()))) {
    throw std::runtime_error("the first session was refused");
  }
  client = join();
  client->result("control.pause");
  client->result("control.reset");
  client->wait_event("session.description", [](const Json& d) { return d.at("epoch") == 2; });
  client->wait_event("session.status", [](const Json& s) { return s.at("tick") == 0; });
  client->mark();
}

std::unique_ptr<TestClient> SessionTest::connect() {
  return std::make_unique<TestClient>(server, ++last_connection_);
}

std::unique_ptr<TestClient> SessionTest::connect_admin() {
  auto admin = connect();
  admin->result("access.enter", {{"token", kAdminToken}});
  return admin;
}

std::unique_ptr<TestClient> SessionTest::connect_from(std::string address) {
  return std::make_unique<TestClient>(server, ++last_connection_, std::move(address));
}

std::unique_ptr<TestClient> SessionTest::join(const std::string& session) {
  auto joined = connect();
  joined->result("session.join", {{"session", session}});
  return joined;
}

void advance_ticks(Simulation& simulation, std::uint64_t ticks) {
  for (std::uint64_t i = 0; i < ticks; ++i) {
    if (simulation.advance(simulation.steps_per_tick()).failed) {
      throw std::runtime_error("the simulation is unstable");
    }
  }
}

std::vector<std::uint8_t> bytes_that_say(std::uint32_t size) {
  std::vector<std::uint8_t> frame{0x28, 0xb5, 0x2f, 0xfd, 0xa0};  // the size in four bytes
  for (int byte = 0; byte < 4; ++byte) frame.push_back(static_cast<std::uint8_t>(size >> 8 * byte));
  return frame;
}

std::string hash_of(const Simulation& simulation) {
  return describe_hash(simulation.state_hash());
}

}  // namespace vat::test
