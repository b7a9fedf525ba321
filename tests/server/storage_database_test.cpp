// What a database is opened as, and what is refused; transactions.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "server/storage/schema.h"
#include "tests/support/temporary_folder.h"

namespace vat::storage_database_test {
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

/// The kind of the error that opening gives; fails the test where it gives none.
StorageError::Kind refusal(const std::string& path, const Schema& schema) {
  try {
    open_database(path, schema);
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
    Database database = open_database(path, {kApplication, kOld});
    database.execute("INSERT INTO things VALUES ('one'), ('two')");
  }
  test::TemporaryFolder folder;
  const std::string path = folder.file("test.db");
};

TEST_F(StorageDatabase, OlderOnesAreBroughtUpToDateWithWhatTheyHold) {
  make_old();
  Database database = open_database(path, {kApplication, kNew});
  EXPECT_EQ(database.number("PRAGMA user_version"), 2);
  EXPECT_EQ(database.number("SELECT count(*) FROM things WHERE size = 5"), 2);
}

TEST_F(StorageDatabase, AMigrationThatFailsLeavesTheOldOne) {
  make_old();
  constexpr const char* kBroken[] = {kNew[0], "ALTER TABLE things RENAME TO items",
                                     "INSERT INTO nothing VALUES (1)"};
  EXPECT_THROW(open_database(path, {kApplication, kBroken}), StorageError);
  Database database = open_database(path, {kApplication, kOld});
  EXPECT_EQ(database.number("PRAGMA user_version"), 1);
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 2);
}

TEST_F(StorageDatabase, ANewerOneIsRefusedAndStaysAsItIs) {
  open_database(path, {kApplication, kNew});
  const std::string before = content_of(path);
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::newer);
  EXPECT_EQ(content_of(path), before);
}

TEST_F(StorageDatabase, AnotherProgramsIsRefused) {
  open_database(path, {kApplication + 1, kOld});
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::corrupt);
}

TEST_F(StorageDatabase, GarbageIsRefusedAndStaysAsItIs) {
  const std::string garbage(5000, 'x');
  folder.write("test.db", garbage);
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::corrupt);
  EXPECT_EQ(content_of(path), garbage);
}

TEST_F(StorageDatabase, ADamagedPageIsFoundBeforeAnythingIsWritten) {
  {
    Database database = open_database(path, {kApplication, kOld});
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

TEST_F(StorageDatabase, AFileThatEndsEarlyIsFound) {
  make_old();
  std::filesystem::resize_file(path, 4096);
  EXPECT_EQ(refusal(path, {kApplication, kOld}), StorageError::Kind::corrupt);
}

TEST_F(StorageDatabase, WhatIsNotCommittedLeavesNothing) {
  Database database = open_database(path, {kApplication, kOld});
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

TEST_F(StorageDatabase, AFullDiskUndoesTheTransactionAndIsToldByItsKind) {
  Database database = open_database(path, {kApplication, kOld});
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
  Transaction transaction(database);  // and it goes on
  database.execute("INSERT INTO things VALUES ('short')");
  transaction.commit();
  EXPECT_EQ(database.number("SELECT count(*) FROM things"), 1);
}

}  // namespace
}  // namespace vat::storage_database_test
