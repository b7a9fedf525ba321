// Many clients ask simultaneously for the last free places. In each round, exactly as many clients
// succeed as there are places.

#include <barrier>
#include <map>

#include "tests/server/fixture/session_fixture.h"
#include "tests/server/transport/transport_fixture.h"

namespace vat::test::admission_race_test {
namespace {

constexpr std::size_t kAsking = 16;
constexpr std::size_t kPlaces = 3;
constexpr int kRounds = 20;

/// Calls `ask(i)` for each i below kAsking simultaneously, each on its own thread.
template <class Ask>
void all_at_once(Ask&& ask) {
  std::barrier start(static_cast<std::ptrdiff_t>(kAsking));
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < kAsking; ++i) {
    threads.emplace_back([&, i] {
      start.arrive_and_wait();
      ask(i);
    });
  }
}

class AdmissionRace : public testing::Test {
 protected:
  AdmissionRace() { limits.max_sessions_per_address = limits.max_sessions = 100; }

  /// Starts a server with one session, `s1`, and connects clients.
  void serve(std::size_t clients_to_connect = kAsking) {
    ServerSettings settings = test_settings(limits);
    settings.threads = 4;
    server = std::make_unique<TestServer>(catalogue, settings);
    EXPECT_TRUE(server->create_session("first", to_scene(mixed_scene_text())).ok());
    clients.resize(clients_to_connect);
    for (std::size_t i = 0; i < clients_to_connect; ++i) connect(i);
  }
  void connect(std::size_t i) {
    clients[i] = std::make_unique<TestClient>(*server, static_cast<int>(i) + 1);
  }
  /// Returns the results of the clients that get one. The others must get an error with this limit.
  std::map<std::size_t, Json> admitted(const char* method, const Json& params,
                                       const std::string& limit, std::size_t maximum = kPlaces) {
    std::vector<Json> replies(kAsking);
    all_at_once([&](std::size_t i) { replies[i] = clients[i]->call(method, params); });
    std::map<std::size_t, Json> results;
    for (std::size_t i = 0; i < kAsking; ++i) {
      if (replies[i].contains("result")) {
        results[i] = replies[i].at("result");
      } else {
        EXPECT_EQ(replies[i].at("error").at("code"), 1005);
        EXPECT_EQ(replies[i].at("error").at("data").at("limit"), limit);
        EXPECT_EQ(replies[i].at("error").at("data").at("maximum"), maximum);
      }
    }
    EXPECT_EQ(results.size(), kPlaces);
    return results;
  }
  void expect_created(const std::string& limit, std::size_t maximum) {
    serve();
    const Json params{{"name", "n"}, {"scene", "mixed"}};
    for (int round = 0; round < kRounds; ++round) {
      for (const auto& [creator, result] : admitted("session.create", params, limit, maximum)) {
        clients[creator]->result("session.close", {{"session", result.at("session")}});
      }
    }
  }

  ServerLimits limits = unhurried_limits();
  const Catalogue catalogue = make_catalogue();
  std::unique_ptr<TestServer> server;
  std::vector<std::unique_ptr<TestClient>> clients;
};

TEST_F(AdmissionRace, ForTheLastConnections) {
  limits.max_connections = kPlaces;
  serve(0);
  for (int round = 0; round < kRounds; ++round) {
    clients.resize(kAsking);
    all_at_once([&](std::size_t i) { connect(i); });
    EXPECT_EQ(std::ranges::count_if(
                  clients, [](const auto& client) { return !client->connection->close_code(); }),
              kPlaces);
    clients.clear();
  }
}

TEST_F(AdmissionRace, ForTheLastPlacesOfASession) {
  limits.max_clients_per_session = kPlaces;
  serve();
  for (int round = 0; round < kRounds; ++round) {
    for (int again = 0; again < 2; ++again) {  // members may join again
      admitted("session.join", {{"session", "s1"}}, "clients_per_session");
    }
    for (const auto& client : clients) client->call("session.leave");
  }
}

TEST_F(AdmissionRace, ForTheLastSessions) {
  limits.max_sessions = 1 + kPlaces;
  expect_created("sessions", 1 + kPlaces);
}

TEST_F(AdmissionRace, ForTheLastSessionsOfAnAddress) {
  limits.max_sessions_per_address = kPlaces;
  expect_created("sessions_per_address", kPlaces);
}

/// Real sockets at several endpoints. Each round uses a new server, because the previous clients
/// count until the server has noticed their disconnection.
class TransportRace : public testing::Test {
 protected:
  TransportRace() {
    settings.port = 0;
    settings.endpoints = 3;
  }
  void expect_places() {
    for (int round = 0; round < kRounds / 4; ++round) EXPECT_EQ(admitted(), kPlaces);
  }

  TransportSettings settings;

 private:
  std::size_t admitted() {
    Recorder echo;
    echo.echo = true;
    const auto transport = make_websocket_transport(settings, echo, [](const HttpRequest&) {
      return HttpResponse{200, "text/plain", "", {}};
    });
    const std::uint16_t port = transport->start();
    std::vector<std::unique_ptr<WsClient>> clients(kAsking);
    std::atomic<std::size_t> count = 0;
    all_at_once([&](std::size_t i) {
      try {
        clients[i] = std::make_unique<WsClient>(port);
        clients[i]->send_text("here");
        count += clients[i]->read_message().payload == "here" ? 1 : 0;
      } catch (const std::runtime_error&) {
        // The server refused this client.
      }
    });
    return count;
  }
};

TEST_F(TransportRace, ForTheLastConnections) {
  settings.max_connections = kPlaces;
  expect_places();
}

TEST_F(TransportRace, ForTheLastConnectionsOfAnAddress) {
  settings.max_connections_per_address = kPlaces;
  expect_places();
}

}  // namespace
}  // namespace vat::test::admission_race_test
