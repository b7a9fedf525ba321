// Frames over slow, long or broken connections: they stay recent, and their rate adapts.

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "server/frames/frame_delivery.h"

namespace vat::test::frame_line_test {
namespace {

using namespace std::chrono_literals;
using Seconds = std::chrono::duration<double>;

/// A frame as received by a viewer.
struct Seen {
  FrameHeader header;
  Seconds age{};  ///< age of the state on arrival
  std::size_t bytes = 0;
};

/// A simulated network line between the server and a viewer that acknowledges each frame on
/// arrival.
class Line final : public Connection {
 public:
  explicit Line(const SteadyClock::time_point& now) : now_(now) {}

  ConnectionId id() const override { return 1; }
  const std::string& address() const override { return address_; }
  void send_text(std::string, std::shared_ptr<const std::string>) override {}
  void send_binary(std::shared_ptr<const std::string> bytes) override {
    sent_.push_back(std::move(bytes));
  }
  std::size_t queued_bytes() const override { return 0; }
  void close(std::uint16_t, std::string_view) override { is_closed = true; }

  /// Returns the next frame that has arrived, in order.
  std::shared_ptr<const std::string> take_arrived() {
    for (; !sent_.empty(); sent_.pop_front()) {
      const double size = static_cast<double>(sent_.front()->size());
      const Seconds length(bytes_per_second > 0 ? size / bytes_per_second : 0);
      free_at_ = std::max(free_at_, now_) + std::chrono::ceil<SteadyClock::duration>(length);
      under_way_.emplace_back(free_at_ + delay, std::move(sent_.front()));
    }
    if (is_broken || under_way_.empty() || under_way_.front().first > now_) return nullptr;
    auto bytes = std::move(under_way_.front().second);
    under_way_.pop_front();
    return bytes;
  }

  std::chrono::milliseconds delay{0};  ///< in each direction
  double bytes_per_second = 0;         ///< to the viewer; 0: no limit
  bool is_broken = false;
  bool is_closed = false;

 private:
  const SteadyClock::time_point& now_;
  SteadyClock::time_point free_at_{};
  std::deque<std::shared_ptr<const std::string>> sent_;
  std::deque<std::pair<SteadyClock::time_point, std::shared_ptr<const std::string>>> under_way_;
  const std::string address_ = "127.0.0.1";
};

class FrameLine : public testing::Test {
 protected:
  static constexpr auto kStep = 1ms;
  static constexpr auto kTick = 20ms;

  FrameLine() {
    const std::uint64_t membership = outbox_->join();
    outbox_->start_epoch(membership, 1);
    delivery_.add(outbox_, outbox_->subscribe(membership, wakes_, now_), {});
  }

  /// Returns the frames that arrive within `time`, or until a frame satisfies `until`.
  std::vector<Seen> watch(Seconds time, const std::function<bool(const Seen&)>& until = {}) {
    std::vector<Seen> all;
    for (const auto end = now_ + time; now_ < end; now_ += kStep) {
      if (now_ >= next_tick_) publish();
      while (const auto bytes = line->take_arrived()) {
        all.push_back(receive(*bytes));
        if (until && until(all.back())) return all;
      }
      for (; !acknowledgements_.empty() && acknowledgements_.front().first <= now_;
           acknowledgements_.pop_front()) {
        EXPECT_TRUE(outbox_->acknowledge(acknowledgements_.front().second, now_));
        if (std::exchange(wakes_->is_woken, false)) {
          delivery_.retry(std::vector<ConnectionId>{1}, now_);
        }
      }
    }
    EXPECT_FALSE(line->is_closed);
    return all;
  }

 private:
  struct Wakes final : FrameWaker {
    void wake(ConnectionId) override { is_woken = true; }
    void frame_rejected(ConnectionId, std::uint32_t) override {}
    bool is_woken = false;
  };

  void publish() {
    next_tick_ += kTick;
    PublishedState state;
    state.header.playing = true;
    state.header.epoch = 1;
    state.header.tick = ++tick_;
    state.header.published = seconds_of(now_);
    state.bodies.resize(1);
    state.bodies[0].id = 1;
    state.bodies[0].positions.assign(100, {1e-3 * static_cast<double>(tick_ % 900), 0.5, 0.5});
    delivery_.publish(state, now_);
  }
  Seen receive(const std::string& bytes) {
    const auto frame =
        decoder_.decode({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    EXPECT_TRUE(frame.ok());
    const FrameHeader& header = frame.value()->header;
    acknowledgements_.emplace_back(now_ + line->delay, header.number);
    return {header, Seconds(seconds_of(now_) - header.published), bytes.size()};
  }
  static double seconds_of(SteadyClock::time_point time) {
    return Seconds(time.time_since_epoch()).count();
  }

  SteadyClock::time_point now_{1h};
  SteadyClock::time_point next_tick_ = now_;
  std::uint64_t tick_ = 0;
  ServerMetrics metrics_;
  const std::shared_ptr<Wakes> wakes_ = std::make_shared<Wakes>();
  FrameDelivery delivery_{Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics_};
  FrameDecoder decoder_;
  std::deque<std::pair<SteadyClock::time_point, std::uint32_t>> acknowledgements_;

 protected:
  const std::shared_ptr<Line> line = std::make_shared<Line>(now_);

 private:
  const std::shared_ptr<ClientOutbox> outbox_ = std::make_shared<ClientOutbox>(line);
};

std::size_t count_older(const std::vector<Seen>& all, Seconds age) {
  return static_cast<std::size_t>(
      std::ranges::count_if(all, [age](const Seen& seen) { return seen.age > age; }));
}

class LongLine : public FrameLine, public testing::WithParamInterface<int> {};

// Frames wait only on the line: the server sends the newest state when there is capacity.
TEST_P(LongLine, FramesAreNoOlderThanTheDelay) {
  line->delay = std::chrono::milliseconds(GetParam()) / 2;
  watch(1s);
  const std::vector<Seen> all = watch(10s);
  // Three frames per round trip, and at most one per tick.
  const double most = std::min(50.0, 3 / (2 * Seconds(line->delay).count()));
  EXPECT_GT(static_cast<double>(all.size()), 0.5 * 10 * most);
  EXPECT_LE(count_older(all, line->delay + kTick), all.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(RoundTrips, LongLine, testing::Values(20, 100, 300));

TEST_F(FrameLine, AThinLineLowersTheRateAndAGoodOneRaisesItAgain) {
  const std::vector<Seen> all = watch(2s);
  ASSERT_EQ(all.back().header.stride, 1U);
  double bytes = 0;
  for (const Seen& seen : all) bytes += static_cast<double>(seen.bytes);
  line->bytes_per_second = bytes / 2 / 3;
  watch(20s, [](const Seen& seen) { return seen.header.stride >= 3; });
  const std::vector<Seen> few = watch(2s);
  EXPECT_GE(few.back().header.stride, 2U);
  // At most three frames are in flight.
  const Seconds way(3 * static_cast<double>(all.back().bytes) / line->bytes_per_second);
  EXPECT_LE(count_older(few, way + 150ms), few.size() / 10);
  line->bytes_per_second = 0;
  const std::vector<Seen> good =
      watch(60s, [](const Seen& seen) { return seen.header.stride == 1; });
  EXPECT_EQ(good.back().header.stride, 1U);
}

// After an interruption, as after a lost packet, the frames in flight arrive late. The next frame
// is recent.
TEST_F(FrameLine, AfterABreakThreeFramesAreOldAtMost) {
  watch(500ms);
  for (int i = 0; i < 4; ++i) {
    line->is_broken = true;
    EXPECT_TRUE(watch(600ms).empty());
    line->is_broken = false;
    const std::vector<Seen> after = watch(1s);
    EXPECT_LE(count_older(after, 100ms), 3U);
    EXPECT_GT(after.size(), 10U);
  }
}

}  // namespace
}  // namespace vat::test::frame_line_test
