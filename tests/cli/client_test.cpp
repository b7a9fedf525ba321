// The C++ client with a real server, over ws and wss.

#include "protocol/client/client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>

#include "server/script/server_process.h"
#include "tests/cli/program.h"
#include "tests/support/certificate.h"
#include "tests/support/patience.h"
#include "tests/support/pool_scene.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::client_test {
namespace {

using namespace client;
using testing::HasSubstr;

constexpr std::chrono::seconds kPatience{60 * kSlowdown};

/// A value that a thread of a client sets once or several times, and the test waits for.
template <class Value>
class Expected {
 public:
  void set(Value value) {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_set_, true)) return;
    promise_.set_value(std::move(value));
  }
  Value wait() {
    std::future<Value> future = promise_.get_future();
    if (future.wait_for(kPatience) != std::future_status::ready) {
      throw std::runtime_error("nothing happened");
    }
    return future.get();
  }

 private:
  std::mutex mutex_;
  bool is_set_ = false;
  std::promise<Value> promise_;
};

class CppClient : public testing::Test {
 protected:
  CppClient() {
    folder_.write("pool.json", kPoolScene);
    write_certificate(certificate_, key_);
  }
  void start(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {
        "serve", "--scenes", folder_.path().string(), "--scene", "pool", "--log-level", "error"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    server_.emplace(VAT_PROGRAM, arguments);
  }
  std::string url(const std::string& scheme) const {
    return scheme + "://127.0.0.1:" + std::to_string(server_->port());
  }
  /// Steps the ball to the time 0.1 s, and compares its position in the frame and in a query.
  static void watch_the_ball(const std::string& url, Options options) {
    Expected<double> height;
    Handlers handlers;
    handlers.on_frame = [&](const Frame& frame) {
      if (frame.tick != 5) return;
      for (const Frame::Body& body : frame.bodies) {
        if (body.name == "ball") height.set(body.center_of_mass.z());
      }
    };
    Client client(url, std::move(options), handlers);
    const SessionJoin::Result joined = client.call<SessionJoin>({.name = "watcher"}).get();
    EXPECT_EQ(joined.name, "watcher");
    client.call<ControlPause>().get();
    client.call<ControlReset>().get();
    client.call<FramesSubscribe>({.max_error = 1e-5}).get();
    EXPECT_EQ(client.call<ControlStep>({.ticks = 5}).get().tick, 5U);
    const StateQuery::Result state =
        client.call<StateQuery>({.bodies = std::vector<Json>{"ball"}}).get();
    EXPECT_NEAR(state.time, 0.1, 1e-12);
    EXPECT_NEAR(height.wait(), state.bodies.at(0).center_of_mass->z(), 1e-5);
  }

  TemporaryFolder folder_;
  std::string certificate_ = folder_.file("certificate.pem");
  std::string key_ = folder_.file("key.pem");
  std::optional<script::ServerProcess> server_;
};

// Calls and frames do not depend on the encryption. The other tests use none.
TEST_F(CppClient, ReceivesFramesAndTrustsTheNamedAuthority) {
  start({"--port", "0", "--tls-certificate", certificate_, "--tls-key", key_});
  watch_the_ball(url("wss"), {.trust = {.authority_file = certificate_}});
}

TEST_F(CppClient, ReportsTheErrorsOfTheServer) {
  start({"--port", "0"});
  Client client(url("ws"));
  client.call<SessionJoin>().get();
  try {
    client.call<ControlSetSpeed>({.speed = 5}).get();
    ADD_FAILURE() << "the server accepted the speed";
  } catch (const CallError& error) {
    EXPECT_EQ(error.kind(), "invalid_params");
    EXPECT_EQ(error.code(), -32602);
    EXPECT_EQ(error.path(), "/speed");
    EXPECT_NE(error.hint(), "");
  }
  const Outcome<InEffect> outcome = client.call<WorldRemoveBody>({.body = 98}).outcome();
  ASSERT_FALSE(outcome.ok());
  EXPECT_EQ(outcome.error().kind(), "no_such_body");
  Expected<std::string> kind;
  client.call<WorldRemoveBody>({.body = 99}, [&](const Outcome<InEffect>& removed) {
    kind.set(removed ? "" : removed.error().kind());
  });
  EXPECT_EQ(kind.wait(), "no_such_body");
}

TEST_F(CppClient, ReceivesEventsAboutNotifications) {
  start({"--port", "0"});
  Expected<std::string> method;
  Handlers handlers;
  handlers.events.notification_rejected = [&](const NotificationRejectedEvent& event) {
    method.set(event.method);
  };
  Client client(url("ws"), {}, handlers);
  EXPECT_TRUE(client.notify<ControlPlay>());  // without a session
  EXPECT_EQ(method.wait(), "control.play");
  client.close();
  EXPECT_FALSE(client.notify<ControlPlay>());
  try {
    client.call<ServerInfo>().get();
    ADD_FAILURE() << "a closed client called a method";
  } catch (const CallError& error) {
    EXPECT_EQ(error.kind(), "disconnected");
  }
}

TEST_F(CppClient, ResumesItsParticipantAfterARestartOfTheServer) {
  const std::string data = folder_.file("data");
  start({"--port", "0", "--data", data, "--drain-seconds", "0"});
  const std::string port = std::to_string(server_->port());
  Expected<SessionJoin::Result> rejoined;
  Expected<std::uint64_t> tick;
  std::atomic<bool> is_back = false;
  Handlers handlers;
  handlers.on_rejoined = [&](const SessionJoin::Result& result) {
    is_back = true;
    rejoined.set(result);
  };
  handlers.on_frame = [&](const Frame& frame) {
    if (is_back) tick.set(frame.tick);
  };
  using namespace std::chrono_literals;
  Client client(url("ws"), {.first_retry = 20ms, .longest_retry = 100ms}, handlers);
  const SessionJoin::Result joined = client.call<SessionJoin>({.name = "watcher"}).get();
  client.call<FramesSubscribe>({.max_error = 0.01}).get();
  EXPECT_EQ(server_->stop(), 0);  // stores the participants
  start({"--port", port, "--data", data});
  const SessionJoin::Result result = rejoined.wait();
  EXPECT_TRUE(result.resumed);
  EXPECT_EQ(result.participant, joined.participant);
  EXPECT_EQ(result.session, joined.session);
  EXPECT_GT(tick.wait(), 0U);  // the subscription continues
}

TEST(CppClientErrors, NameTheFailure) {
  EXPECT_THROW(Client("http://127.0.0.1"), std::invalid_argument);
  EXPECT_THROW(Client("ws://127.0.0.1", {.timeout = std::chrono::milliseconds(0)}),
               std::invalid_argument);
  try {
    const Client client("ws://127.0.0.1:1");
    ADD_FAILURE() << "connected";
  } catch (const ConnectError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no server at 127.0.0.1:1"));
  }
}

}  // namespace
}  // namespace vat::test::client_test
