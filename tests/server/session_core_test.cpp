#include "server/session/session_core.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>

#include "protocol/scene_json.h"
#include "tests/server/fake_connection.h"
#include "tests/server/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_core_test {
namespace {

class SessionCoreTest : public testing::Test {
 protected:
  std::shared_ptr<FakeConnection> subscribe() {
    const auto connection = std::make_shared<FakeConnection>(viewers_.size() + 1);
    const auto outbox = std::make_shared<ClientOutbox>(connection);
    viewers_.emplace_back(connection, outbox);
    core.join(outbox, outbox->join(), {}, now);
    core.subscribe(*core.participants().find_client(connection->id()), {}, now);
    core.announce();
    wait();
    return connection;
  }
  /// Everybody acknowledges what comes.
  void tick() {
    ASSERT_TRUE(core.tick(now, true));
    core.publish_tick();
    wait();
    for (const auto& [connection, outbox] : viewers_) {
      ASSERT_TRUE(outbox->acknowledge(connection->frames().back().header.number, now));
    }
  }
  /// Until the frame threads have done what was posted to them.
  void wait() {
    std::promise<void> done;
    boost::asio::post(environment.shared.frame_threads, [&] { done.set_value(); });
    done.get_future().wait();
  }
  bool counted(const std::string& sample) const {
    return environment.shared.metrics.to_text({}).find('\n' + sample + '\n') != std::string::npos;
  }

  const SteadyClock::time_point now = SteadyClock::now();
  const LoneEnvironment environment;
  SessionCore core{
      "s1", {"one"}, Simulation::create(to_scene(mixed_scene_text())).value(), environment.shared};

 private:
  std::vector<std::pair<std::shared_ptr<FakeConnection>, std::shared_ptr<ClientOutbox>>> viewers_;
};

// The second frame of each builds on one frame, those after it on two, as everybody's.
TEST_F(SessionCoreTest, WhoComesBetweenTwoTicksSharesAKeyFrame) {
  const auto first = subscribe();
  tick();
  tick();
  tick();
  EXPECT_TRUE(counted("vat_frames_encoded_total 3"));
  const auto second = subscribe();
  const auto third = subscribe();
  EXPECT_TRUE(second->frames().empty()) << "it comes with the next tick";
  tick();
  EXPECT_TRUE(counted("vat_key_frames_encoded_total 2")) << "one for both";
  EXPECT_TRUE(counted("vat_frames_encoded_total 5"));
  for (const auto& connection : {first, second, third}) {
    ASSERT_FALSE(connection->frames().empty());
    EXPECT_EQ(connection->frames().back().header.tick, 4U);
  }
}

TEST_F(SessionCoreTest, WhoComesWhileItPausesGetsAFrameAtOnce) {
  core.set_playing(false);
  EXPECT_EQ(subscribe()->frames().size(), 1U);
}

}  // namespace
}  // namespace vat::test::session_core_test
