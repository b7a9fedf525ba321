#include "server/cluster/session_locator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/cluster/nats_servers.h"
#include "tests/support/wait.h"

namespace vat::test::session_locator_test {
namespace {

class SessionLocatorTest : public testing::Test {
 protected:
  LocatedSession make(SessionLocator& from, const std::string& name) {
    LocatedSession session;
    session.number = from.next_number();
    session.name = name;
    session.owner = "a";
    session.instruction_set = "baseline";
    return session;
  }
  template <class Operation>
  static bool conflicts(const Operation& operation) {
    try {
      operation();
    } catch (const NatsError& error) {
      return error.kind() == NatsError::Kind::conflict;
    }
    return false;
  }

  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  SessionLocator locator{connection};
};

TEST_F(SessionLocatorTest, OneOfTwoNodesTakesASession) {
  const LocatedSession created = locator.create(make(locator, "pool"));
  EXPECT_EQ(created.epoch, 1U);
  const LocatedSession taken = locator.take(created, "b");
  EXPECT_EQ(taken.owner, "b");
  EXPECT_EQ(taken.epoch, 2U);
  EXPECT_TRUE(conflicts([&] { locator.take(created, "c"); }));
  EXPECT_TRUE(conflicts([&] { locator.renew(created); }));
  EXPECT_EQ(locator.read(created.number)->owner, "b");
  const LocatedSession released = locator.release(taken, "c");
  EXPECT_EQ(released.owner, "");
  EXPECT_EQ(released.successor, "c");
  EXPECT_EQ(locator.take(released, "c").epoch, 3U);
}

TEST_F(SessionLocatorTest, NumbersAndNamesAreUnique) {
  const LocatedSession first = locator.create(make(locator, "pool"));
  EXPECT_THROW(locator.create(make(locator, "pool")), NameInUse);
  const LocatedSession other = locator.create(make(locator, "lake"));
  EXPECT_GT(other.number, first.number);
  EXPECT_THROW(locator.rename(other, "pool"), NameInUse);
  const LocatedSession renamed = locator.rename(first, "sea");
  locator.rename(other, "pool");
  locator.remove(renamed);
  locator.create(make(locator, "sea"));
  // Sessions without a name do not conflict.
  locator.create(make(locator, ""));
  locator.create(make(locator, ""));
}

TEST_F(SessionLocatorTest, ANameCanBeTakenAgainAfterAFailedRename) {
  const LocatedSession old = locator.create(make(locator, "pool"));
  const LocatedSession renewed = locator.renew(old);
  try {
    locator.rename(old, "sea");  // takes the name, and then finds another entry
    ADD_FAILURE();
  } catch (const NameInUse&) {
    ADD_FAILURE() << "the name is not that of another session";
  } catch (const NatsError& error) {
    EXPECT_EQ(error.kind(), NatsError::Kind::conflict);
  }
  EXPECT_EQ(locator.rename(renewed, "sea").name, "sea");
}

TEST_F(SessionLocatorTest, TheNameOfANodeThatEndedDuringACreationIsFree) {
  Bucket bucket(connection, "vat-sessions", std::chrono::milliseconds(0));
  bucket.create("name.706f6f6c", "77");  // "pool", for a session that does not exist
  EXPECT_EQ(locator.create(make(locator, "pool")).name, "pool");
}

TEST_F(SessionLocatorTest, TheCopyFollowsOtherNodes) {
  locator.watch([](const LocatedSession&) {});
  connection.flush(std::chrono::milliseconds(5000));
  SessionLocator other(connection);
  const LocatedSession created = other.create(make(other, "pool"));
  ASSERT_TRUE(wait_until([&] { return locator.find(created.number).has_value(); }));
  EXPECT_EQ(locator.find(created.number)->name, "pool");
  other.remove(created);
  EXPECT_TRUE(wait_until([&] { return locator.all().empty(); }));
}

TEST_F(SessionLocatorTest, ARefreshFindsWhatTheWatchHasMissed) {
  const LocatedSession created = locator.create(make(locator, "pool"));
  SessionLocator other(connection);
  other.refresh();
  ASSERT_EQ(other.all().size(), 1U);
  locator.remove(created);
  other.refresh();
  EXPECT_TRUE(other.all().empty());
}

TEST_F(SessionLocatorTest, ARefreshReadsANewBucketCompletely) {
  SessionLocator other(connection);
  for (int i = 0; i < 3; ++i) locator.create(make(locator, ""));
  other.refresh();
  ASSERT_EQ(other.all().size(), 3U);
  connection.request("$JS.API.STREAM.DELETE.KV_vat-sessions", {}, std::chrono::milliseconds(5000));
  SessionLocator later(connection);
  const LocatedSession created = later.create(make(later, "pool"));
  other.refresh();
  ASSERT_EQ(other.all().size(), 1U);
  EXPECT_EQ(other.find(created.number)->name, "pool");
}

TEST_F(SessionLocatorTest, MarksOfRemovedSessionsAreDroppedAfterManyChanges) {
  constexpr std::uint64_t kKept = 8;
  SessionLocator dropping(connection, kKept);
  SessionLocator late(connection, kKept);
  const LocatedSession removed = dropping.create(make(dropping, "pool"));
  LocatedSession other = dropping.create(make(dropping, "lake"));
  late.refresh();
  ASSERT_EQ(late.all().size(), 2U);
  dropping.remove(removed);
  Bucket bucket(connection, "vat-sessions", std::chrono::milliseconds(0));
  const auto count_marks = [&] {
    return std::ranges::count_if(bucket.changes_since(0), &Bucket::Entry::is_removed);
  };
  dropping.refresh();
  EXPECT_EQ(count_marks(), 2) << "of the session and its name";
  for (std::uint64_t n = 0; n < kKept; ++n) other = dropping.renew(other);
  dropping.refresh();
  EXPECT_TRUE(wait_until([&] { return count_marks() == 0; }));
  late.refresh();
  EXPECT_EQ(late.all().size(), 1U) << "without the mark";
  EXPECT_EQ(late.find(other.number)->name, "lake");
}

TEST_F(SessionLocatorTest, ANewNodeDropsTheMarksOfEarlierOnes) {
  const LocatedSession other = locator.create(make(locator, "lake"));
  locator.remove(locator.create(make(locator, "pool")));
  locator.renew(other);
  SessionLocator later(connection, 1);
  later.refresh();
  later.refresh();
  Bucket bucket(connection, "vat-sessions", std::chrono::milliseconds(0));
  EXPECT_TRUE(wait_until(
      [&] { return std::ranges::none_of(bucket.changes_since(0), &Bucket::Entry::is_removed); }));
}

TEST_F(SessionLocatorTest, SessionsAreListedByOwner) {
  const LocatedSession first = locator.create(make(locator, ""));
  const LocatedSession second = locator.create(make(locator, ""));
  const auto numbers_of = [&](const std::string& owner) {
    std::vector<std::uint64_t> numbers;
    for (const LocatedSession& one : locator.sessions_of(owner)) numbers.push_back(one.number);
    return numbers;
  };
  EXPECT_THAT(locator.owners(), testing::ElementsAre("a"));
  EXPECT_THAT(numbers_of("a"), testing::ElementsAre(first.number, second.number));
  const LocatedSession taken = locator.take(first, "b");
  EXPECT_THAT(locator.owners(), testing::ElementsAre("a", "b"));
  EXPECT_THAT(numbers_of("a"), testing::ElementsAre(second.number));
  EXPECT_THAT(numbers_of("b"), testing::ElementsAre(first.number));
  locator.release(taken, "c");
  EXPECT_THAT(locator.owners(), testing::ElementsAre("", "a"));
  EXPECT_THAT(numbers_of("c"), testing::IsEmpty());
}

}  // namespace
}  // namespace vat::test::session_locator_test
