// A viewer behind a long, thin or broken line: its frames stay young, it gets what it can take, and
// all of it once the line is good again.

#include <thread>

#include "protocol/frame_codec.h"
#include "tests/server/message_record.h"
#include "tests/server/network_proxy.h"
#include "tests/server/session_fixture.h"
#include "tests/server/transport_client.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::slow_network_test {
namespace {

using std::chrono::milliseconds;
using Seconds = std::chrono::duration<double>;

// A ball on a spring's end that never comes to rest: small frames that always show something new.
const char* const kRestlessScene = R"({
  "format": "vat.scene/1", "name": "restless", "title": "Restless",
  "materials": [{"name": "wood", "density": 600}],
  "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "lid": true,
          "motion": {"type": "slide", "axis": [1, 0, 0], "stroke": 0.2, "period": 1}},
  "numerics": {"integrator": "velocity_verlet", "step": 0.01, "tick": 0.02},
  "bodies": [{"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.1,
              "shape": {"type": "sphere", "radius": 0.15}, "position": [0.5, 0.5, 0.5]}]})";

double wall_clock() {
  return Seconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// What a viewer sees of a frame.
struct Seen {
  double at = 0;   ///< [s since 1970]
  double age = 0;  ///< [s]
  std::uint32_t number = 0;
  unsigned stride = 0;
  double bytes = 0;
};

class SlowNetwork : public testing::Test {
 protected:
  SlowNetwork()
      : catalogue_(Catalogue::open(folder_.path().string()).value()),
        server_(catalogue_, settings()),
        transport_(make_websocket_transport(transport_settings(), server_, {})) {
    if (!server_.create_session("restless", to_scene(kRestlessScene))) {
      throw std::runtime_error("the session was refused");
    }
    port_ = transport_->start();
  }
  void TearDown() override {
    server_.stop();
    transport_->stop();
  }

  void watch(NetworkProxy& proxy) {
    client_ = std::make_unique<WsClient>(proxy.port());
    send(R"({"jsonrpc":"2.0","method":"session.join"})");
    send(R"({"jsonrpc":"2.0","method":"frames.subscribe"})");
  }
  /// Reads and acknowledges for so long, or until a frame is as wanted; what came.
  std::vector<Seen> look(Seconds time, const std::function<bool(const Seen&)>& until = {}) {
    std::vector<Seen> all;
    for (const double end = wall_clock() + time.count(); wall_clock() < end;) {
      const auto message = client_->read_message();
      if (message.opcode != 2) {
        text_bytes_ += static_cast<double>(message.payload.size());
        if (auto* record = message_record()) record->received("watching", message.payload);
        continue;
      }
      all.push_back(take(message.payload));
      if (until && until(all.back())) break;
    }
    return all;
  }
  std::uint16_t port() const { return port_; }
  double text_bytes() const { return text_bytes_; }

 private:
  void send(const std::string& text) {
    if (auto* record = message_record()) record->sent("watching", text);
    client_->send_text(text);
  }
  static ServerSettings settings() {
    ServerSettings settings;
    settings.threads = 2;
    return settings;
  }
  static TransportSettings transport_settings() {
    TransportSettings settings;
    settings.port = 0;
    return settings;
  }
  Seen take(const std::string& bytes) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const auto frame = decoder_.decode({data, bytes.size()});
    if (!frame) throw std::runtime_error("a damaged frame: " + frame.errors().front().code);
    const FrameHeader& header = frame.value()->header;
    send(R"({"jsonrpc":"2.0","method":"frames.ack","params":{"number":)" +
         std::to_string(header.number) + "}}");
    const double now = wall_clock();
    return {now, now - header.published, header.number, header.stride,
            static_cast<double>(bytes.size())};
  }

  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  SessionServer server_;
  std::unique_ptr<Transport> transport_;
  std::uint16_t port_ = 0;
  std::unique_ptr<WsClient> client_;
  FrameDecoder decoder_;
  double text_bytes_ = 0;
};

std::size_t count_older(const std::vector<Seen>& all, double age) {
  return static_cast<std::size_t>(
      std::ranges::count_if(all, [age](const Seen& seen) { return seen.age > age; }));
}

class LongLine : public SlowNetwork, public testing::WithParamInterface<int> {};

// No frame waits anywhere but on the line: each is sent when there is room, and is the newest then.
// Beyond the delay there is the time to make a frame, and what a busy machine takes, which may be
// much for a few.
TEST_P(LongLine, FramesAreNoOlderThanTheWayIsLong) {
  const Seconds way = milliseconds(GetParam()) / 2.0;
  NetworkProxy proxy(port(), {std::chrono::duration_cast<milliseconds>(way), 0, false});
  watch(proxy);
  look(Seconds(1));
  const std::vector<Seen> all = look(Seconds(4));
  // Three frames in a round trip, but for a quarter of them that may be missed and a stride of
  // four.
  const double most = std::min(50.0, 3 / (2 * way.count()));
  EXPECT_GT(static_cast<double>(all.size()), 4 * most / 4 / 2);
  EXPECT_LT(count_older(all, way.count() + 0.15), all.size() / 10 + 1);
  for (const Seen& seen : all) EXPECT_GE(seen.age, way.count() - 0.001);
}

INSTANTIATE_TEST_SUITE_P(RoundTrips, LongLine, testing::Values(20, 100, 300));

// A line that takes a third of the bytes of all frames, beside the statuses. Three frames are under
// way at most, and one status between them.
TEST_F(SlowNetwork, AThinLineLowersTheRateAndAGoodOneRaisesItAgain) {
  NetworkProxy proxy(port(), {});
  watch(proxy);
  look(Seconds(0.5));  // with the description
  const double texts_before = text_bytes();
  const std::vector<Seen> all = look(Seconds(2));
  const double text_rate = (text_bytes() - texts_before) / 2;
  double bytes = 0;
  for (const Seen& seen : all) bytes += seen.bytes;
  const double rate = bytes / 2 / 3 + text_rate;
  proxy.set({milliseconds(0), rate, false});
  look(Seconds(20), [](const Seen& seen) { return seen.stride >= 3; });
  const std::vector<Seen> few = look(Seconds(2));
  EXPECT_GE(few.back().stride, 2U);
  const double way = (3 * bytes / static_cast<double>(all.size()) + text_rate) / rate;
  EXPECT_LT(count_older(few, way + 0.15), few.size() / 10 + 1);

  proxy.set({});
  const std::vector<Seen> good =
      look(Seconds(60), [](const Seen& seen) { return seen.stride == 1; });
  EXPECT_EQ(good.back().stride, 1U);
}

// As after a lost packet: what was in flight comes late, at most three frames of it; the next is
// new. A flood of all that was missed would be hundreds.
TEST_F(SlowNetwork, AfterABreakThreeFramesAreOldAtMost) {
  NetworkProxy proxy(port(), {});
  watch(proxy);
  look(Seconds(0.5));
  for (int i = 0; i < 4; ++i) {
    proxy.set({milliseconds(0), 0, true});
    std::this_thread::sleep_for(milliseconds(600));
    const double end = wall_clock();
    proxy.set({});
    const std::vector<Seen> after = look(Seconds(1));
    // Those published before the break's last tenth of a second.
    const auto is_old = [end](const Seen& seen) { return seen.at - seen.age < end - 0.1; };
    EXPECT_LE(std::ranges::count_if(after, is_old), 3);
    EXPECT_GT(after.size(), 3U);
  }
}

}  // namespace
}  // namespace vat::test::slow_network_test
