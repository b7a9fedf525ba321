#include "server/storage/sqlite/main_database.h"

namespace vat {
namespace {

constexpr std::uint32_t kMainApplication = 0x76617473;  // "vats"

constexpr const char* kMainSteps[] = {
    R"(
CREATE TABLE sessions (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL,
  instruction_set TEXT NOT NULL,
  settings TEXT NOT NULL,
  closed INTEGER NOT NULL DEFAULT 0,
  reached INTEGER NOT NULL DEFAULT 0,
  position INTEGER,
  tick INTEGER,
  sequence INTEGER,
  hash INTEGER,
  epoch INTEGER,
  playing INTEGER,
  speed REAL,
  participants TEXT
) STRICT;
CREATE TABLE log (
  session INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  position INTEGER NOT NULL,
  tick INTEGER NOT NULL,
  participant INTEGER NOT NULL,
  method TEXT NOT NULL,
  params TEXT NOT NULL,
  refused INTEGER NOT NULL DEFAULT 0,
  PRIMARY KEY (session, sequence)
) STRICT, WITHOUT ROWID;
)",
    R"(
CREATE TABLE tokens (
  hash BLOB PRIMARY KEY,
  role TEXT NOT NULL,
  session TEXT NOT NULL,
  uses INTEGER,
  ends REAL NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE scenes (
  name TEXT PRIMARY KEY,
  title TEXT NOT NULL,
  description TEXT NOT NULL,
  saved_by TEXT NOT NULL,
  address TEXT NOT NULL,
  key BLOB NOT NULL,
  time REAL NOT NULL,
  bytes INTEGER NOT NULL,
  scene TEXT NOT NULL
) STRICT;
CREATE INDEX scenes_by_address ON scenes (address, bytes);
)"};

}  // namespace

MainDatabase::MainDatabase(const std::string& path, Durability durability)
    : database(open_database(path, main_schema(), durability)) {}

Schema main_schema() {
  return {kMainApplication, kMainSteps};
}

}  // namespace vat
