#include "server/session/frame_feed.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>

#include "tests/server/fake_connection.h"

namespace vat::test {
namespace {

constexpr std::uint32_t kEpoch = 1;

PublishedState make_state(std::uint64_t tick, bool has_speeds) {
  PublishedState state;
  state.header.epoch = kEpoch;
  state.header.tick = tick;
  state.bodies.resize(1);
  state.bodies[0].id = 1;
  state.bodies[0].positions = {{0.1, 0.2, 0.3}};
  if (has_speeds) state.bodies[0].attributes[0] = {2.0F};
  return state;
}

/// Keeps the pool's only thread from all other work.
class Block {
 public:
  explicit Block(boost::asio::thread_pool& pool) {
    boost::asio::post(pool, [released = released_.get_future().share()] { released.wait(); });
  }
  void release() { released_.set_value(); }

 private:
  std::promise<void> released_;
};

// A state that waits was published for those who were there before.
TEST(FrameFeed, GivesNobodyAStateWithoutTheAttributesThatHeAskedFor) {
  boost::asio::thread_pool pool(1);
  ServerMetrics metrics;
  const auto feed = std::make_shared<FrameFeed>("s1", std::nullopt, metrics, pool);
  const auto connection = std::make_shared<FakeConnection>(1);
  const auto outbox = std::make_shared<ClientOutbox>(connection);
  const std::uint64_t membership = outbox->join();
  outbox->start_epoch(membership, kEpoch);
  Subscription wish;
  wish.attribute_errors[0] = 0.01;

  Block block(pool);
  feed->publish(make_state(7, false));
  feed->add(outbox, outbox->subscribe(membership, feed, SteadyClock::now()), wish);
  block.release();
  std::promise<void> done;
  boost::asio::post(pool, [&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_TRUE(connection->frames().empty());

  feed->publish(make_state(8, true));
  pool.join();
  ASSERT_EQ(connection->frames().size(), 1U);
  EXPECT_EQ(connection->frames()[0].header.tick, 8U);
}

}  // namespace
}  // namespace vat::test
