// Attacks by flooding: memory use, and the delay for another client. The memory of
// this process includes the attackers.

#include <algorithm>
#include <atomic>

#include "tests/server/transport/transport_fixture.h"
#include "tests/support/memory/resident_bytes.h"
#include "tests/support/wait.h"

namespace vat::test::transport_flood_test {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Memory beyond the initial use [bytes]. A sanitizer's shadow memory is many times as large.
constexpr double kMaxMemory = 48e6 * kSlowdown;
/// Round trip of a message to the server [s]. A server that waits for its attackers takes 10 s, the
/// time limit of a handshake.
constexpr double kMaxDelay = 8;  // [s]

class TransportFloodTest : public TransportTest {
 protected:
  /// Runs an attack while another client sends requests continuously.
  template <class Attack>
  void withstand(Attack&& attack) {
    recorder.echo = true;
    start();
    WsClient user(port, "127.0.0.2");
    const double before = resident_bytes();
    std::atomic<bool> attacked = false;
    std::atomic<double> most = before;
    std::vector<double> delays;
    std::thread other([&] {
      while (!attacked || delays.size() < 20) {
        const auto begin = steady_clock::now();
        user.send_text("alive?");
        EXPECT_EQ(user.read_message().payload, "alive?");
        delays.push_back(Seconds(steady_clock::now() - begin).count());
        most = std::max<double>(most, resident_bytes());
        pause(milliseconds(5));
      }
    });
    attack();
    attacked = true;
    other.join();
    EXPECT_LT(most - before, kMaxMemory);
    EXPECT_LT(std::ranges::max(delays), kMaxDelay);
  }
  /// Writes until the peer closes. Returns the number of bytes written.
  static std::size_t write_until_closed(RawClient& client, const std::string& bytes,
                                        std::size_t most, milliseconds interval = milliseconds(0)) {
    std::size_t written = 0;
    try {
      for (; written < most; written += bytes.size()) {
        client.write(bytes);
        pause(interval);
      }
    } catch (const std::runtime_error&) {  // the server closed the connection
    }
    return written;
  }
};

// A slow message occupies only its connection, and this must answer pings.
TEST_F(TransportFloodTest, DripsOfMessages) {
  settings.ping_interval = milliseconds(300);
  withstand([&] {
    WsClient drip(port);
    const std::string frame = client_frame(1, std::string(100'000, 'x'));
    drip.raw().write(frame.substr(0, 100));
    EXPECT_LT(write_until_closed(drip.raw(), "x", 100, milliseconds(50)), 100U);
  });
}

TEST_F(TransportFloodTest, HandshakesAsFastAsTheyCome) {
  withstand([&] {
    constexpr int kThreads = 4;
    constexpr int kEach = 500;
    std::vector<std::thread> attackers;
    for (int t = 0; t < kThreads; ++t) {
      attackers.emplace_back([&] {
        for (int i = 0; i < kEach; ++i) WsClient{port}.raw().reset();
      });
    }
    for (std::thread& attacker : attackers) attacker.join();
  });
}

// The server does not allocate memory for announced bytes before they arrive.
TEST_F(TransportFloodTest, FramesThatSayTheyAreHuge) {
  withstand([&] {
    for (int i = 0; i < 200; ++i) {
      WsClient client(port);
      std::string header("\x82\xff", 2);
      header += std::string("\x3f\xff\xff\xff\xff\xff\xff\xff", 8) + "\1\2\3\4";
      client.raw().write(header);
      EXPECT_EQ(client.read_close(), 1009);
    }
  });
}

TEST_F(TransportFloodTest, FragmentsWithoutEnd) {
  withstand([&] {
    WsClient client(port);
    client.raw().write(client_frame(1, "", false));
    std::string empty;
    for (int i = 0; i < 1000; ++i) empty += client_frame(0, "", false);
    for (int i = 0; i < 500; ++i) client.raw().write(empty);
    std::string single;
    for (int i = 0; i < 1000; ++i) single += client_frame(0, "x", false);
    write_until_closed(client.raw(), single, 3'000'000 * 7);
    EXPECT_EQ(client.read_close(), 1009);
  });
}

}  // namespace

}  // namespace vat::test::transport_flood_test
