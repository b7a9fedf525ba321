// Power failures at many moments of a recorded run: a second server starts on contents that the
// disk may then have.

#include "server/storage/sqlite/database.h"
#include "tests/server/fixture/host.h"
#include "tests/server/fixture/test_disk.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::power_cut_test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kCuts = 500;
constexpr std::uint32_t kSeed = 20;
constexpr int kRounds = 24;

using Log = std::vector<std::string>;
using Place = std::pair<std::size_t, std::uint64_t>;  // number of log entries, tick

/// Returns the log of s1. Returns an empty log if the database has no tables yet.
Log read_log(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/vat.db")) return {};
  Database database(folder + "/vat.db", Database::Mode::read);
  if (database.number("SELECT count(*) FROM sqlite_master WHERE name = 'log'") == 0) return {};
  Statement query = database.prepare(
      "SELECT sequence, position, method, params FROM log WHERE session = 1 ORDER BY sequence");
  Log log;
  while (query.step()) {
    log.push_back(std::to_string(query.count(0)) + " at " + std::to_string(query.count(1)) + ' ' +
                  std::string(query.text(2)) + std::string(query.text(3)));
  }
  return log;
}

/// State of the client's knowledge after an answer.
struct Answered {
  std::size_t operations = 0;  ///< of the disk, before which the answer was received
  Place place;
  std::map<std::string, std::string> saves;  ///< hashes by name
};

/// A server that executes commands on a recorded disk.
class RecordedRun {
 public:
  RecordedRun() {
    disk_->record(record);
    for (int round = 0; round < kRounds; ++round) {
      if (round % (kRounds / 2) == 0) restart();
      run(round);
    }
    hashes[{1, 0}] = hashes.at({2, 0});  // created, not yet paused
    host_.reset();
    log = read_log(folder_.file("data"));
    disk_.reset();  // servers of the test use the disk of the system
  }

  DiskRecord record;
  Log log;
  std::vector<Answered> answers;
  std::map<Place, std::string> hashes;

 private:
  TestClient& client() { return *host_->client; }

  void restart() {
    host_.reset();
    ServerSettings settings = test_settings(unhurried_limits(), folder_.file("data"));
    settings.storage.checkpoint_after = 0ms;
    settings.storage.checkpoint_bytes = 100'000;  // the oldest ones are removed
    settings.storage.checkpoint_bytes_per_second = 1e9;
    host_.emplace(catalogue_, settings, clock_);
    note(record.size());
  }

  /// Notes the state of the session, which all operations before `operations` led to.
  void note(std::size_t operations) {
    const Json state = client().result("session.hash");
    host_->server.flush();
    const Place place{read_log(folder_.file("data")).size(), state.at("tick")};
    hashes[place] = state.at("hash");
    answers.push_back({operations, place, saves_});
  }

  void step() {
    auto [entries, tick] = answers.back().place;
    // The failure may occur after the command is stored and before its tick.
    hashes[{entries + 1, tick}] = hashes.at({entries, tick});
    execute("control.step", {{"ticks", 1}});
  }

  Json execute(std::string_view method, const Json& params = nullptr) {
    const Json result = client().result(method, params);
    note(record.size());
    return result;
  }

  void run(int round) {
    execute("world.set_gravity", {{"gravity", {0.01 * round, 0, -9}}});
    execute("world.apply_force", {{"body", 3}, {"force", {0, 5, 0}}, {"duration", 0.1}});
    step();
    if (round % 2 == 0) add_and_remove(round);
    if (round % 2 == 1) drag();
    if (round % 3 == 0) save(round);
    if (round % 6 == 5) execute("session.load", {{"name", saves_.begin()->first}});
    if (round % 4 == 3) play();
  }

  void add_and_remove(int round) {
    const Json ball = wooden_ball("ball " + std::to_string(round));
    const Json body = execute("world.add_body", {{"body", ball}}).at("body");
    step();
    execute("world.remove_body", {{"body", body}});
  }

  void drag() {
    const std::uint64_t grab = client().grab(3);
    note(record.size());
    step();
    execute("grab.end", {{"grab", grab}});
  }

  void save(int round) {
    const std::string name = "save " + std::to_string(round);
    const Json saved = client().result("session.save", {{"name", name}});
    saves_[name] = saved.at("hash");
    note(record.size());
  }

  /// Plays for more than a second, after which the logs are copied into the databases.
  void play() {
    execute("control.play");
    for (int tick = 0; tick < 60; ++tick) {
      clock_.advance(20ms);
      note(0);  // a tick is not an answer
    }
    execute("control.pause");
  }

  const TemporaryFolder folder_;
  const Catalogue catalogue_ = make_catalogue();
  ManualClock clock_;
  std::optional<TestDisk> disk_{std::in_place};
  std::optional<Host> host_;
  std::map<std::string, std::string> saves_;
};

/// Returns the last answer before an operation of the disk.
Answered find_answer(const RecordedRun& run, std::size_t operations) {
  Answered last;
  for (const Answered& answer : run.answers) {
    if (answer.operations > 0 && answer.operations <= operations) last = answer;
  }
  return last;
}

void check_log(const RecordedRun& run, const Log& log, const Answered& answered) {
  ASSERT_GE(log.size(), answered.place.first) << "an answered command is missing";
  ASSERT_LE(log.size(), run.log.size());
  EXPECT_TRUE(std::equal(log.begin(), log.end(), run.log.begin()));
}

/// Starts a server on the contents of the disk, and compares its session with the run.
void check_contents(const RecordedRun& run, const std::string& folder, const Answered& answered) {
  static const Catalogue kCatalogue = make_catalogue();
  const Log log = read_log(folder);
  check_log(run, log, answered);
  ManualClock clock;
  ServerSettings settings = test_settings(unhurried_limits(), folder);
  settings.storage.durability = Durability::process;  // faster
  Host host(kCatalogue, settings, clock);
  if (log.empty()) return;
  EXPECT_TRUE(host.client->events("session.diverged").empty());
  const Place place{log.size(), host.tick()};
  EXPECT_GE(place, answered.place) << "an answered tick is missing";
  ASSERT_TRUE(run.hashes.contains(place)) << place.first << " entries, tick " << place.second;
  EXPECT_EQ(host.hash(), run.hashes.at(place));
  for (const auto& [name, hash] : answered.saves) {
    host.client->result("session.load", {{"name", name}});
    EXPECT_EQ(host.hash(), hash) << name;
  }
}

TEST(PowerCut, AtAnyMomentLosesNothingThatWasAnswered) {
  const RecordedRun run;
  ASSERT_GT(run.record.size(), kCuts);
  PowerCut cut(run.record, kSeed);
  for (std::size_t i = 1; i <= kCuts; ++i) {
    const std::size_t operations = run.record.size() * i / kCuts;
    SCOPED_TRACE("after operation " + std::to_string(operations));
    cut.run_to(operations);
    const TemporaryFolder folder;
    cut.write_contents(folder.file("data"));
    check_contents(run, folder.file("data"), find_answer(run, operations));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace vat::test::power_cut_test
