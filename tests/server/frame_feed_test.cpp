#include "server/session/frame_feed.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>

#include "tests/server/fake_connection.h"

namespace vat::test::frame_feed_test {
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
  PublishedState state = make_state(7, false);
  feed->publish(state);
  EXPECT_TRUE(feed->add(outbox, outbox->subscribe(membership, feed, SteadyClock::now()), wish))
      << "a further state should be published";
  block.release();
  std::promise<void> done;
  boost::asio::post(pool, [&] { done.set_value(); });
  done.get_future().wait();
  EXPECT_TRUE(connection->frames().empty());

  state = make_state(8, true);
  feed->publish(state);
  pool.join();
  ASSERT_EQ(connection->frames().size(), 1U);
  EXPECT_EQ(connection->frames()[0].header.tick, 8U);
}

// One that is filled, one that waits, one that is taken out of the mail and one that is shown: from
// the fifth on a tick finds the memory that an earlier one has used.
TEST(FrameFeed, FourStatesGoRound) {
  constexpr std::size_t kParticles = 1000;
  boost::asio::thread_pool pool(1);
  ServerMetrics metrics;
  const auto feed = std::make_shared<FrameFeed>("s1", std::nullopt, metrics, pool);
  PublishedState state;
  for (std::uint64_t tick = 1; tick <= 100; ++tick) {
    if (tick > 4) {
      ASSERT_EQ(state.bodies.size(), 1U);
      ASSERT_GE(state.bodies[0].positions.capacity(), kParticles);
    }
    state.header = {.epoch = kEpoch, .tick = tick};
    state.bodies.resize(1);
    state.bodies[0].positions.assign(kParticles, Vec3(0, 0, 1e-3 * static_cast<double>(tick)));
    feed->publish(state);
    if (tick % 3 == 0) continue;  // the next one takes its place where it still waits
    std::promise<void> done;
    boost::asio::post(pool, [&] { done.set_value(); });
    done.get_future().wait();
  }
  pool.join();
}

}  // namespace
}  // namespace vat::test::frame_feed_test
