// What SIGTERM does to a server that is in use.

#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "protocol/json_reader.h"
#include "server/script/client.h"
#include "server/script/server_process.h"
#include "tests/recovery/load.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

class Drain : public testing::Test {
 protected:
  script::ServerProcess start(const std::string& seconds) {
    return {VAT_PROGRAM,
            {"serve", "--port", "0", "--scene", "rigid-stack", "--data", folder.file("data"),
             "--drain-seconds", seconds, "--log-level", "error"}};
  }
  std::unique_ptr<script::Client> connect(std::uint16_t port) {
    const std::string url = "ws://127.0.0.1:" + std::to_string(port) + "/ws";
    return connect_websocket(script::read_websocket_url(url), {}, steady_clock::now() + 10s).client;
  }
  void send(script::Client& client, int id, const std::string& method, const Json& params) {
    client.send_text(
        Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump());
  }
  /// The next message that has this id or event; the test ends where none comes.
  Json wait(script::Client& client, const Json& id_or_event) {
    for (;;) {
      const auto message = client.next(steady_clock::now() + 10s);
      if (!message) throw std::runtime_error("no " + id_or_event.dump());
      if (message->kind == script::Message::Kind::closed) return {{"closed", message->close_code}};
      if (message->kind != script::Message::Kind::text) continue;
      Json json = Json::parse(message->bytes);
      if (json.value("id", Json()) == id_or_event) return json;
      if (json.value("method", Json()) == id_or_event) return json;
    }
  }
  const TemporaryFolder folder;
};

TEST_F(Drain, ClientsAreToldAndNobodyNewComesAndItEndsWhenTheLastHasGone) {
  std::string hash;
  {
    script::ServerProcess server = start("8");
    const auto client = connect(server.port());
    send(*client, 1, "session.join", Json::object());
    wait(*client, 1);
    send(*client, 2, "control.step", {{"ticks", 5}});
    wait(*client, 2);
    send(*client, 3, "session.hash", Json::object());
    hash = wait(*client, 3).at("result").at("hash");
    const auto begin = steady_clock::now();
    auto status = std::async(std::launch::async, [&] { return server.stop(); });
    EXPECT_EQ(wait(*client, "server.draining").at("params").at("seconds"), 8);
    send(*client, 4, "session.create", {{"name", "new"}, {"scene", "rigid-stack"}});
    EXPECT_EQ(wait(*client, 4).at("error").at("data").at("kind"), "not_allowed");
    const auto late = connect(server.port());
    EXPECT_TRUE(late == nullptr || wait(*late, 0).at("closed") == 1013);
    send(*client, 5, "control.step", {{"ticks", 3}});  // who is there goes on
    EXPECT_TRUE(wait(*client, 5).contains("result"));
    send(*client, 6, "session.hash", Json::object());
    hash = wait(*client, 6).at("result").at("hash");
    client->close();
    wait(*client, 0);
    EXPECT_EQ(status.get(), 0);
    EXPECT_LT(steady_clock::now() - begin, 6s);
  }
  script::ServerProcess server = start("0");
  const auto client = connect(server.port());
  send(*client, 1, "session.join", Json::object());
  wait(*client, 1);
  send(*client, 2, "session.hash", Json::object());
  EXPECT_EQ(wait(*client, 2).at("result").at("hash"), hash);
}

TEST_F(Drain, WhoStaysIsClosedAtTheDeadline) {
  script::ServerProcess server = start("1");
  const auto client = connect(server.port());
  send(*client, 1, "session.join", Json::object());
  wait(*client, 1);
  const auto begin = steady_clock::now();
  auto status = std::async(std::launch::async, [&] { return server.stop(); });
  EXPECT_EQ(wait(*client, 0).at("closed"), 1001);
  EXPECT_GE(steady_clock::now() - begin, 1s);
  EXPECT_EQ(status.get(), 0);
}

}  // namespace
}  // namespace vat::test
