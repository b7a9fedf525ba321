// The journal: common transactions, durability, and faults of the disk.

#include "server/storage/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "tests/server/fixture/test_disk.h"
#include "tests/support/manual_clock.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::journal_test {
namespace {

using testing::ElementsAre;
using Failure = std::optional<StorageError::Kind>;

class JournalTest : public testing::Test {
 protected:
  JournalTest() { open(Durability::power); }
  ~JournalTest() override { disk.release_syncs(); }  // a failed test may hold them

  void open(Durability durability) {
    journal.reset();
    main.reset();
    main = std::make_unique<MainDatabase>(folder.file("vat.db"), durability);
    main->database.execute("CREATE TABLE IF NOT EXISTS numbers (number INTEGER)");
    journal = std::make_unique<Journal>(*main, clock);
  }
  /// Writes a number, and notes its completion.
  void write(int number) {
    journal->post(
        [this, number] {
          main->database.prepare("INSERT INTO numbers VALUES (?)")
              .bind(0, std::int64_t{number})
              .run();
        },
        [this, number](Failure failure) {
          const std::lock_guard lock(mutex);
          if (failure) {
            failed.push_back(*failure);
          } else {
            written.push_back(number);
          }
        });
  }
  std::vector<std::int64_t> stored() {
    std::vector<std::int64_t> numbers;
    Database reader(folder.file("vat.db"), Database::Mode::read);
    Statement query = reader.prepare("SELECT number FROM numbers ORDER BY rowid");
    while (query.step()) numbers.push_back(query.integer(0));
    return numbers;
  }
  std::vector<int> written_now() {
    const std::lock_guard lock(mutex);
    return written;
  }

  TestDisk disk;
  const TemporaryFolder folder;
  ManualClock clock;
  std::unique_ptr<MainDatabase> main;
  std::mutex mutex;
  std::vector<int> written;
  std::vector<StorageError::Kind> failed;
  std::unique_ptr<Journal> journal;
};

TEST_F(JournalTest, WritesThatWaitShareATransactionAndASync) {
  disk.hold_syncs();
  write(1);
  disk.wait_for_held_sync();
  for (int number = 2; number <= 50; ++number) write(number);
  EXPECT_THAT(written_now(), ElementsAre()) << "completed before the sync";
  const std::size_t before = disk.sync_count();
  disk.release_syncs();
  journal->flush();
  EXPECT_EQ(disk.sync_count() - before, 2U);
  EXPECT_EQ(journal->counts().journal_commits, 2U);
  EXPECT_EQ(journal->counts().journal_writes, 50U);
  std::vector<int> expected(50);
  std::iota(expected.begin(), expected.end(), 1);
  EXPECT_EQ(written_now(), expected);
  EXPECT_EQ(stored().size(), 50U);
}

TEST_F(JournalTest, ForACrashOfTheProcessNothingIsSynchronised) {
  open(Durability::process);
  write(1);  // SQLite synchronises the header of a new log
  journal->flush();
  disk.hold_syncs();
  write(2);
  journal->flush();
  EXPECT_THAT(written_now(), ElementsAre(1, 2));
  disk.release_syncs();
}

TEST_F(JournalTest, AFaultOfTheDiskRefusesTheWriteUntilItEnds) {
  const std::pair<TestDisk::Fault, StorageError::Kind> faults[] = {
      {TestDisk::Fault::full, StorageError::Kind::full},
      {TestDisk::Fault::short_write, StorageError::Kind::full},
      {TestDisk::Fault::io_error, StorageError::Kind::failed},
      {TestDisk::Fault::sync_error, StorageError::Kind::failed},
      {TestDisk::Fault::read_only, StorageError::Kind::read_only}};
  write(0);
  journal->flush();
  std::vector<std::int64_t> expected = {0};
  for (const auto& [fault, kind] : faults) {
    const std::int64_t number = expected.back() + 1;
    SCOPED_TRACE(to_string(kind));
    disk.fail(fault);
    write(100);
    journal->flush();
    EXPECT_THAT(failed, ElementsAre(kind));
    EXPECT_EQ(journal->counts().failing, kind);
    disk.fail({});
    EXPECT_EQ(stored(), expected);
    write(static_cast<int>(number));
    journal->flush();
    expected.push_back(number);
    EXPECT_EQ(stored(), expected);
    EXPECT_FALSE(journal->counts().failing);
    failed.clear();
  }
  EXPECT_EQ(journal->counts().failures, std::size(faults));
}

TEST_F(JournalTest, AWriteThatFailsDoesNotRefuseTheOthersOfItsTransaction) {
  disk.hold_syncs();
  write(1);
  disk.wait_for_held_sync();
  write(2);
  std::atomic<bool> is_refused = false;
  journal->post([] { throw StorageError(StorageError::Kind::full, "too long"); },
                [&](Failure failure) { is_refused = failure == StorageError::Kind::full; });
  journal->post([] { throw std::runtime_error("a fault"); });
  write(3);
  disk.release_syncs();
  journal->flush();
  EXPECT_TRUE(is_refused);
  EXPECT_THAT(written_now(), ElementsAre(1, 2, 3));
  EXPECT_THAT(stored(), ElementsAre(1, 2, 3));
  EXPECT_THAT(failed, ElementsAre());
}

TEST_F(JournalTest, TheExpectedTimeFollowsTheDisk) {
  EXPECT_EQ(journal->expected_time().count(), 0);
  for (int i = 0; i < 50; ++i) {
    disk.hold_syncs();
    write(i);
    disk.wait_for_held_sync();
    clock.advance(std::chrono::milliseconds(8));
    disk.release_syncs();
    journal->flush();
  }
  EXPECT_GE(journal->expected_time(), std::chrono::microseconds(7900));
  EXPECT_LE(journal->expected_time(), std::chrono::microseconds(8500));
}

TEST_F(JournalTest, ItsEndCompletesItsWrites) {
  for (int number = 1; number <= 5; ++number) write(number);
  journal.reset();
  EXPECT_THAT(written_now(), ElementsAre(1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace vat::test::journal_test
