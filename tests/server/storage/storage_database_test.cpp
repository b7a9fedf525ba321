// Opening a database, refused files, and transactions.

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>

#include "server/storage/session_store.h"
#include "server/storage/sqlite/schema.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::storage_database_test {
namespace {

constexpr std::uint32_t kApplication = 77;
constexpr const char* kOld[] = {"CREATE TABLE things (name TEXT NOT NULL) STRICT"};
constexpr const char* kNew[] = {"CREATE TABLE things (name TEXT NOT NULL) STRICT",
                                "ALTER TABLE things ADD COLUMN size INTEGER NOT NULL DEFAULT 5"};

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

/// Returns the kind of the error of opening. Fails the test if there is no error.
StorageError::Kind refusal(const std::string& path, const Schema& schema) {
  try {
    open_database(path, schema, Durability::process);
  } catch (const StorageError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    return error.kind();
  }
  ADD_FAILURE() << path << " was opened";
  return StorageError::Kind::failed;
}

class StorageDatabase : public testing::Test {
 protected:
  void make_old() {
    Database database = open_database(path, {kApplication, kOld}, Durability::process);
    database.execute("INSERT INTO things VALUES ('one'), ('two')");
  }
  test::TemporaryFolder folder;
  const std::string path = folder.file("test.db");
};

TEST_F(StorageDatabase, OlderOnesAreConvertedWithTheirContent) {
  make_old();
  Database database = open_database(path, {kApplication, kNew}, Durability::process);
  EXPECT_EQ(database.number("PRAGMA user_version"), 2);
  EXPECT_EQ(database.number("SELECT count(*) FROM things WHERE size = 5"), 2);
}

TEST_F(StorageDatabase, AMigrationThatFailsLeavesTheOldOne) {
  make_old();
  constexpr const char* kBroken[] = {kNew[0], "ALTER TABLE things RENAME TO items",
                                     "INSERT INTO nothing VALUES (1)"};
  EXPECT_THROW(open_database(path, {kApplication, kBroken}, Durability::process), StorageError);
  Database database = open_database(path, {kApplication, kOld}, Durability::process);
  EXPECT_EQ(database.number("PRAGMA user_version"), 1);
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 2);
}

TEST_F(StorageDatabase, ANewerOneIsRefusedAndStaysAsItIs) {
  open_database(path, {kApplication, kNew}, Durability::process);
  const std::string before = content_of(path);
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::newer);
  EXPECT_EQ(content_of(path), before);
}

TEST_F(StorageDatabase, OtherAndIncompleteFilesAreRefusedAndStayAsTheyAre) {
  open_database(path, {kApplication + 1, kOld}, Durability::process);
  const std::string of_another_program = content_of(path);
  std::filesystem::remove(path);
  make_old();
  const std::string cut = content_of(path).substr(0, 4096);
  for (const std::string& content : {of_another_program, cut, std::string(5000, 'x')}) {
    folder.write("test.db", content);
    EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::corrupt);
    EXPECT_EQ(content_of(path), content);
  }
}

TEST_F(StorageDatabase, ADamagedPageIsFoundBeforeAnythingIsWritten) {
  {
    Database database = open_database(path, {kApplication, kOld}, Durability::process);
    Transaction transaction(database);
    Statement insert = database.prepare("INSERT INTO things VALUES (?)");
    for (int i = 0; i < 1000; ++i) insert.bind(0, std::string_view("a name of some length")).run();
    transaction.commit();
  }
  std::string bytes = content_of(path);
  ASSERT_GT(bytes.size(), 4U * 4096);
  bytes.replace(3 * 4096, 64, std::string(64, '\xff'));  // the header of a page of the table
  folder.write("test.db", bytes);
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::corrupt);
  EXPECT_EQ(content_of(path), bytes);
}

TEST_F(StorageDatabase, UncommittedChangesAreNotStored) {
  Database database = open_database(path, {kApplication, kOld}, Durability::process);
  {
    Transaction transaction(database);
    database.execute("INSERT INTO things VALUES ('lost')");
  }
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 0);
  Transaction transaction(database);
  database.execute("INSERT INTO things VALUES ('kept')");
  transaction.commit();
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 1);
}

TEST_F(StorageDatabase, AFullDiskUndoesTheTransactionAndIsReportedByItsKind) {
  Database database = open_database(path, {kApplication, kOld}, Durability::process);
  database.number("PRAGMA max_page_count = 8");
  const std::string long_name(10'000, 'n');
  auto kind = StorageError::Kind::failed;
  try {
    Transaction transaction(database);
    for (int i = 0; i < 10; ++i) {
      database.prepare("INSERT INTO things VALUES (?)").bind(0, std::string_view(long_name)).run();
    }
    transaction.commit();
  } catch (const StorageError& error) {
    kind = error.kind();
  }
  EXPECT_EQ(kind, StorageError::Kind::full);
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 0);
  Transaction transaction(database);  // the database remains usable
  database.execute("INSERT INTO things VALUES ('short')");
  transaction.commit();
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 1);
}

LogEntry entry(std::uint64_t sequence, std::uint64_t position, std::string params = "{}") {
  return {sequence, position, position, 3, "world.set_gravity", std::move(params), false};
}

std::vector<std::uint64_t> sequences(SessionStore& store, std::uint64_t session) {
  std::vector<std::uint64_t> sequences;
  for (auto entries = store.read(session, 0); !entries.empty();
       entries = store.read(session, sequences.back())) {
    for (const LogEntry& e : entries) sequences.push_back(e.sequence);
  }
  return sequences;
}

class StorageSessions : public testing::Test {
 protected:
  std::uint64_t create(SessionStore& store) {
    StoredSession session;
    session.name = "a name";
    session.instruction_set = "avx2";
    session.settings = R"({"locked":true})";
    return store.create(session, {1, 0, 0, 0, "scene.load", R"({"scene":"pool"})", false});
  }
  test::TemporaryFolder folder;
  const std::string path = folder.file("vat.db");
};

TEST_F(StorageSessions, ComeBackWithAllThatWasWritten) {
  std::uint64_t number = 0;
  {
    SessionStore store(path);
    number = create(store);
    store.append(number, entry(2, 10, R"({"gravity":[0,0,-1]})"));
    store.write_progress(number, {12, 11, 2, 0xfedcba9876543210, 4, true, 0.5, "[1]"});
    EXPECT_EQ(store.sessions().at(0).reached, 12U);
    store.reach(number, 20);
    store.reach(number, 15);  // earlier than the stored position
  }
  SessionStore store(path);
  const std::vector<StoredSession> sessions = store.sessions();
  ASSERT_EQ(sessions.size(), 1U);
  const StoredSession& session = sessions.front();
  EXPECT_EQ(session.number, number);
  EXPECT_EQ(session.name, "a name");
  EXPECT_EQ(session.instruction_set, "avx2");
  EXPECT_EQ(session.settings, R"({"locked":true})");
  EXPECT_EQ(session.reached, 20U);
  ASSERT_TRUE(session.progress);
  EXPECT_EQ(session.progress->position, 12U);
  EXPECT_EQ(session.progress->tick, 11U);
  EXPECT_EQ(session.progress->sequence, 2U);
  EXPECT_EQ(session.progress->hash, 0xfedcba9876543210);
  EXPECT_EQ(session.progress->epoch, 4U);
  EXPECT_TRUE(session.progress->playing);
  EXPECT_EQ(session.progress->speed, 0.5);
  EXPECT_EQ(session.progress->participants, "[1]");

  const std::vector<LogEntry> log = store.read(number, 1);
  ASSERT_EQ(log.size(), 1U);
  EXPECT_EQ(log[0].sequence, 2U);
  EXPECT_EQ(log[0].position, 10U);
  EXPECT_EQ(log[0].participant, 3U);
  EXPECT_EQ(log[0].method, "world.set_gravity");
  EXPECT_EQ(log[0].params, R"({"gravity":[0,0,-1]})");
}

TEST_F(StorageSessions, ClosedSessionsAreNotRestoredAndTheirNumbersNotReused) {
  std::uint64_t number = 0;
  {
    SessionStore store(path);
    number = create(store);
    store.close(number);
    EXPECT_TRUE(store.sessions().empty());
  }
  SessionStore store(path);
  EXPECT_TRUE(store.sessions().empty());
  store.remove_closed();
  EXPECT_TRUE(store.read(number, 0).empty());
  EXPECT_GT(create(store), number);
}

TEST_F(StorageSessions, RefusedEntriesAreMarked) {
  SessionStore store(path);
  const std::uint64_t number = create(store);
  store.append(number, entry(2, 1));
  store.append(number, entry(3, 1));
  store.refuse(number, 2);
  EXPECT_TRUE(store.find(number, 2).value().refused);
  EXPECT_FALSE(store.find(number, 3).value().refused);
  EXPECT_FALSE(store.find(number, 4));
}

TEST_F(StorageSessions, ADamagedOrderOfTheLogIsReported) {
  std::uint64_t number = 0;
  {
    SessionStore store(path);
    number = create(store);
  }
  // Texts are greater than all numbers, so that each read would return this entry.
  Database(path, Database::Mode::create)
      .execute(
          "ALTER TABLE log RENAME TO old; CREATE TABLE log AS SELECT * FROM old;"
          "UPDATE log SET sequence = 'x'");
  SessionStore store(path);
  EXPECT_THROW(store.read(number, 0), StorageError);
}

TEST_F(StorageSessions, LongLogsAreReadInParts) {
  SessionStore store(path);
  const std::uint64_t number = create(store);
  const std::uint64_t other = create(store);
  std::vector<LogEntry> entries;
  for (std::uint64_t i = 2; i <= 2000; ++i) entries.push_back(entry(i, i));
  store.append(number, entries);
  const std::vector<std::uint64_t> all = sequences(store, number);
  ASSERT_EQ(all.size(), 2000U);
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i + 1);
  EXPECT_EQ(sequences(store, other).size(), 1U);
}

TEST_F(StorageSessions, ATrimmedLogKeepsRequiredEntries) {
  SessionStore store(path);
  const std::uint64_t number = create(store);
  const std::uint64_t other = create(store);
  for (std::uint64_t i = 2; i <= 9; ++i) store.append(number, entry(i, i, R"({"a":1})"));
  store.trim(number, 7, 3);
  EXPECT_EQ(sequences(store, number), (std::vector<std::uint64_t>{3, 8, 9}));
  EXPECT_EQ(store.log_bytes(number), 3 * std::string(R"({"a":1})").size());
  EXPECT_EQ(sequences(store, other).size(), 1U);
}

TEST_F(StorageSessions, EntriesOfOneCallAreWrittenTogether) {
  SessionStore store(path);
  const std::uint64_t number = create(store);
  const std::vector<LogEntry> entries = {entry(2, 1), entry(3, 1),
                                         entry(2, 1)};  // sequence 2 occurs twice
  EXPECT_THROW(store.append(number, entries), StorageError);
  EXPECT_EQ(sequences(store, number).size(), 1U);
  store.append(number, entry(2, 1));
  EXPECT_EQ(sequences(store, number).size(), 2U);
}

}  // namespace
}  // namespace vat::test::storage_database_test
