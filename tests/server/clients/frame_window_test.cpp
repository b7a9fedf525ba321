#include "server/clients/frame_window.h"

#include <gtest/gtest.h>

namespace vat::test::frame_window_test {
namespace {

using namespace std::chrono_literals;

class FrameWindowTest : public testing::Test {
 protected:
  /// Sends a frame that is acknowledged after `delay`.
  void pass(std::chrono::milliseconds delay) {
    window.sent(++number, now);
    now += delay;
    EXPECT_TRUE(window.acknowledge(number, now));
  }
  SteadyClock::time_point now{1h};
  std::uint32_t number = 0;
  FrameWindow window;
};

TEST_F(FrameWindowTest, KnowsFramesInFlightAndTheirAges) {
  EXPECT_FALSE(window.waits_since());
  const auto first = now;
  window.sent(5, now);
  window.sent(7, now += 10ms);
  window.sent(8, now += 10ms);
  EXPECT_EQ(window.in_flight(), 3U);
  EXPECT_EQ(window.waits_since(), first);
  EXPECT_TRUE(window.acknowledge(4, now));
  EXPECT_EQ(window.in_flight(), 3U);
  EXPECT_TRUE(window.acknowledge(6, now)) << "acknowledges frame 5";
  EXPECT_EQ(window.in_flight(), 2U);
  EXPECT_EQ(window.waits_since(), first + 10ms);
  EXPECT_FALSE(window.acknowledge(9, now));
  EXPECT_FALSE(window.acknowledge(0, now));
  EXPECT_TRUE(window.acknowledge(8, now));
  EXPECT_EQ(window.in_flight(), 0U);
  EXPECT_FALSE(window.waits_since());
  EXPECT_TRUE(window.acknowledge(8, now)) << "a repeated acknowledgement has no effect";
  window.clear();
  EXPECT_FALSE(window.acknowledge(8, now)) << "acknowledgement of another session";
}

// If several frames are acknowledged together, the latest determines the delay.
TEST_F(FrameWindowTest, MeasuresFromTheFrameThatIsAcknowledged) {
  window.sent(1, now);
  window.sent(2, now += 100ms);
  EXPECT_TRUE(window.acknowledge(2, now + 30ms));
  EXPECT_EQ(window.delays().count, 1U);
  EXPECT_DOUBLE_EQ(window.delays().mean.count(), 0.03);
  EXPECT_DOUBLE_EQ(window.delays().least.count(), 0.03);
}

// A client can know the number of a frame before it receives the frame.
TEST_F(FrameWindowTest, AnAcknowledgementOlderThanItsFrameIsNoMeasurement) {
  window.sent(1, now + 1ms);
  EXPECT_TRUE(window.acknowledge(1, now));
  EXPECT_EQ(window.in_flight(), 0U);
  EXPECT_EQ(window.delays().count, 0U);
}

TEST_F(FrameWindowTest, TheMeanFollowsAndTheLeastStaysForTwentySeconds) {
  for (int i = 0; i < 10; ++i) pass(20ms);
  for (int i = 0; i < 20; ++i) pass(100ms);
  EXPECT_NEAR(window.delays().mean.count(), 0.1, 0.001);
  EXPECT_DOUBLE_EQ(window.delays().least.count(), 0.02);
  for (int i = 0; i < 185; ++i) pass(100ms);
  EXPECT_DOUBLE_EQ(window.delays().least.count(), 0.1) << "a longer minimum is not a queue";
}

}  // namespace
}  // namespace vat::test::frame_window_test
