#include "server/clients/frame_window.h"

#include <gtest/gtest.h>

namespace vat::test::frame_window_test {
namespace {

using namespace std::chrono_literals;

const SteadyClock::time_point kStart{};

TEST(FrameWindow, MeasuresTheDelayOfTheNewestAcknowledgedFrame) {
  FrameWindow window;
  window.sent(1, kStart);
  window.sent(2, kStart + 10ms);
  EXPECT_EQ(window.waits_since(), kStart);
  EXPECT_TRUE(window.acknowledge(2, kStart + 30ms));
  EXPECT_EQ(window.in_flight(), 0U);
  EXPECT_EQ(window.waits_since(), std::nullopt);
  EXPECT_EQ(window.delays().count, 1U);
  EXPECT_EQ(window.delays().mean, 20ms);
  EXPECT_EQ(window.delays().least, 20ms);
}

TEST(FrameWindow, RefusesNumbersThatWereNotSent) {
  FrameWindow window;
  window.sent(5, kStart);
  EXPECT_FALSE(window.acknowledge(0, kStart));
  EXPECT_FALSE(window.acknowledge(6, kStart));
  EXPECT_TRUE(window.acknowledge(4, kStart));
  EXPECT_EQ(window.in_flight(), 1U);
}

// A client can know the number of a frame before it receives the frame.
TEST(FrameWindow, AnAcknowledgementOlderThanItsFrameIsNoMeasurement) {
  FrameWindow window;
  window.sent(1, kStart + 1ms);
  EXPECT_TRUE(window.acknowledge(1, kStart));
  EXPECT_EQ(window.in_flight(), 0U);
  EXPECT_EQ(window.delays().count, 0U);
  window.sent(2, kStart + 2ms);
  EXPECT_TRUE(window.acknowledge(2, kStart + 5ms));
  EXPECT_EQ(window.delays().mean, 3ms);
}

}  // namespace
}  // namespace vat::test::frame_window_test
