// The certificate is read again after SIGHUP and after a change of its files.

#include "server/cli/serve/certificate_watch.h"

#include <gtest/gtest.h>

#include <csignal>

#include "tests/support/patience.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::certificate_watch_test {
namespace {

using namespace std::chrono_literals;

class CertificateWatchTest : public testing::Test {
 protected:
  CertificateWatchTest() {
    folder.write("certificate.pem", "first");
    folder.write("key.pem", "key");
  }
  void watch(std::chrono::milliseconds interval) {
    watch_.emplace(
        io, std::vector{folder.file("certificate.pem"), folder.file("key.pem")},
        [this] {
          ++reads;
          if (fails) throw std::runtime_error("broken");
        },
        interval);
  }
  /// Runs the handlers of `count` timers or signals.
  void run(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(io.run_one_for(10s * kSlowdown), 1U);
  }

  const TemporaryFolder folder;
  boost::asio::io_context io;
  int reads = 0;
  bool fails = false;

 private:
  std::optional<CertificateWatch> watch_;
};

TEST_F(CertificateWatchTest, ReadsAfterEachSignal) {
  watch(1h);
  for (int expected = 1; expected <= 3; ++expected) {
    fails = expected == 2;
    std::raise(SIGHUP);
    while (reads < expected) ASSERT_EQ(io.run_one_for(10s * kSlowdown), 1U);
    EXPECT_EQ(reads, expected);
  }
}

TEST_F(CertificateWatchTest, ReadsOnceAfterAChange) {
  watch(1ms);
  run(3);
  EXPECT_EQ(reads, 0) << "the files are unchanged";
  folder.write("certificate.pem", "the second");
  run(3);
  EXPECT_EQ(reads, 1);
  folder.write("key.pem", "the second key");
  fails = true;
  run(3);
  EXPECT_EQ(reads, 2) << "a failure is not repeated without a further change";
  fails = false;
  folder.write("key.pem", "the right key");
  run(3);
  EXPECT_EQ(reads, 3);
  std::filesystem::remove(folder.file("key.pem"));
  run(3);
  EXPECT_EQ(reads, 4);
}

}  // namespace
}  // namespace vat::test::certificate_watch_test
