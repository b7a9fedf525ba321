// Every limit of server.info: its setting, and a test at its value and one beyond.

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "server/settings/serve_settings.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::limit_table_test {
namespace {

struct Limit {
  const char* name;
  const char* setting;  ///< null: fixed by PROTOCOL.md or the core
  std::string test;     ///< "Suite.Name" as in ctest
};

const std::vector<Limit>& limit_table() {
  static const std::vector<Limit> kTable{
      {"connections", "max_connections", "TransportEndpointsTest.LimitsHoldForAllTogether"},
      {"connections_per_address", "max_connections_per_address",
       "TransportHostileTest.AnAddressHasItsShareOfTheConnections"},
      {"sessions", "max_sessions", "AdmissionRace.ForTheLastSessions"},
      {"sessions_per_address", "max_sessions_per_address",
       "AbandonedSession.MakeRoomForNewOnesOfTheirAddress"},
      {"clients_per_session", "max_clients", "AdmissionRace.ForTheLastPlacesOfASession"},
      {"particles", "max_particles", "SceneLimits.HoldAtTheirValueAndNotBeyond"},
      {"springs", "max_springs", "SceneLimits.HoldAtTheirValueAndNotBeyond"},
      {"particles_in_all", "max_particles_in_all", "SceneLimits.HoldAtTheirValueAndNotBeyond"},
      {"springs_in_all", "max_springs_in_all", "SceneLimits.HoldAtTheirValueAndNotBeyond"},
      {"particle_steps_per_tick", "max_particle_steps_per_tick",
       "SceneLimits.HoldAtTheirValueAndNotBeyond"},
      {"message_bytes", "max_message_bytes", "MessageLimits.BytesOfAMessage"},
      {"scene_message_bytes", "max_scene_message_bytes", "MessageLimits.BytesOfAMessage"},
      {"message_depth", "max_message_depth", "MessageLimits.DepthAndValuesOfAMessage"},
      {"message_values", "max_message_values", "MessageLimits.DepthAndValuesOfAMessage"},
      {"commands_in_flight", "max_commands_in_flight", "Outbox.CommandsInFlightAreBounded"},
      {"command_bytes_in_flight", "max_bytes_in_flight", "MessageLimits.BytesInFlight"},
      {"queries_per_second", "max_queries_per_second", "MessageMeter.EachClassHasItsOwnLimit"},
      {"controls_per_second", "max_controls_per_second", "MessageMeter.EachClassHasItsOwnLimit"},
      {"pointer_moves_per_second", "max_pointer_moves_per_second",
       "MessageMeter.EachClassHasItsOwnLimit"},
      {"scenes_per_second", "max_scenes_per_second", "MessageMeter.EachClassHasItsOwnLimit"},
      {"reads_per_second", "max_reads_per_second", "MessageMeter.EachClassHasItsOwnLimit"},
      {"read_bytes_per_second", "max_read_bytes_per_second",
       "ReadBudget.IsExceededByBytesOrByTime"},
      {"read_seconds_per_second", "max_read_seconds_per_second",
       "ReadBudget.IsExceededByBytesOrByTime"},
      {"session_read_bytes_per_second", "max_session_read_bytes_per_second",
       "SessionReadsTest.OfAllClientsHaveABudgetToo"},
      {"session_read_seconds_per_second", "max_session_read_seconds_per_second",
       "ReadBudget.IsExceededByBytesOrByTime"},
      {"message_bytes_per_second", "max_message_bytes_per_second",
       "MessageMeter.BytesAndRefusalsAreLimited"},
      {"burst_seconds", "burst_seconds", "MessageMeter.EachClassHasItsOwnLimit"},
      {"refusals_per_second", "max_refusals_per_second", "MessageMeter.BytesAndRefusalsAreLimited"},
      {"grabs_per_client", "max_grabs", "SessionGrabs.OfAClientAreAtMostTenAndOfASessionSixtyFour"},
      {"grabs_per_session", nullptr, "SessionGrabs.OfAClientAreAtMostTenAndOfASessionSixtyFour"},
      {"applied_forces", nullptr, "SessionGrabs.ForcesOfASessionAreBoundedToo"},
      {"bodies", nullptr, "FixedLimits.BodiesOfAScene"},
      {"name_bytes", nullptr, "GoodParameters.TheEndsOfTheRangesAreAllowed"},
      {"ticks_per_step", nullptr, "GoodParameters.TheEndsOfTheRangesAreAllowed"},
      {"frame_window", nullptr, "Outbox.TakesThreeFramesThatAreNotAcknowledged"},
      {"frame_groups", nullptr, "FrameDeliveryTest.EveryViewerHasATurnWithTooManyGroups"},
      {"frame_patience_seconds", "frame_patience_seconds",
       "Outbox.AClientWithoutAcknowledgementsIsClosedAfterThePatience"},
      {"grab_idle_seconds", "grab_idle_seconds", "IdleGrabs.EndAndThoseThatMoveDoNot"},
      {"presence", nullptr, "Presence.HasAHundredParticipantsAtMost"},
      {"connections_listed", nullptr, "StateConnections.AreAsManyAsWereAskedForAtMost"},
      {"tokens", "max_tokens", "AccessTokens.AreBoundedAndOldOnesMakeRoom"},
      {"resume_seconds", "resume_seconds", "AwayForAMoment.LeaveAndReleaseTheirGrabs"},
      {"handshake_seconds", "handshake_seconds",
       "TransportHostileTest.AHandshakeThatNeverEndsIsCutOff"},
      {"ping_seconds", "ping_seconds", "TransportHostileTest.ASilentPeerIsDropped"},
      {"hibernate_after_seconds", "hibernate_after",
       "EmptySession.HibernatesInTimeAndContinuesWhenSomebodyJoins"},
      {"expire_after_seconds", "expire_after", "ExpiringSession.EndsInTimeButNotTheFirst"},
      {"replay_expire_after_seconds", "replay_expire_after",
       "EmptyReplay.EndsInTimeThoughSessionsDoNot"},
      {"control_queue_bytes", "max_control_queue_bytes",
       "Outbox.AClientThatReadsNothingIsClosedBeforeItsQueuePassesAMebibyte"},
      {"queue_bytes_in_all", "max_queue_bytes_in_all",
       "QueueLimit.ClosesTheLongestQueuesBeyondTheLimit"},
      {"memory_bytes", "max_memory", "MemoryLimit.HoldsAtItsValueAndNotBeyond"},
      {"replays", nullptr, "ReplaySession.ThereAreSoManyAtMost"},
      {"recording_ticks", nullptr, "ReplaySession.RefusesRecordingsThatAreTooLong"},
      {"recording_entries", nullptr, "ReplaySession.RefusesRecordingsThatAreTooLong"},
      {"imports", nullptr, "Imports.AreSoManyAtMost"},
      {"import_bytes", nullptr, "Imports.HaveSoManyBytesAtMost"},
      {"recording_bytes", "max_recording_bytes", "LimitedRecordings.AreRefusedBeyondTheirSize"},
      {"states_per_session", "max_states_per_session", "SavedStatesTest.CountAndBytesAreLimited"},
      {"state_bytes_per_session", "max_state_bytes_per_session",
       "SavedStatesTest.CountAndBytesAreLimited"},
      {"state_bytes_in_all", "max_state_bytes_in_all", "SavedStatesTest.CountAndBytesAreLimited"},
      {"scenes_per_address", "max_scenes_per_address", "SavedScenesTest.CountAndBytesAreLimited"},
      {"scene_bytes_per_address", "max_scene_bytes_per_address",
       "SavedScenesTest.CountAndBytesAreLimited"},
      {"scenes_in_all", "max_scenes_in_all", "SavedScenesTest.CountAndBytesAreLimited"},
      {"scene_bytes_in_all", "max_scene_bytes_in_all", "SavedScenesTest.CountAndBytesAreLimited"},
      {"download_bytes", "max_download_bytes", "Downloads.AreBounded"},
  };
  return kTable;
}

/// Groups of settings that are not limits of server.info.
const std::set<std::string> kOtherGroups = {"Server", "Access", "Storage"};

/// Returns the minimum of a setting plus one. The values differ between settings.
double chosen_value(const Setting& setting, std::size_t place) {
  return std::stod(setting.range) + 1 + static_cast<double>(place);
}

Json limits_told(const ServeSettings& settings) {
  const Catalogue catalogue = make_catalogue();
  ServerSettings of_server;
  of_server.limits = settings.limits;
  TestServer server(catalogue, of_server);
  TestClient client(server, 1);
  return client.result("server.info").at("limits");
}

std::string sources_of_tests() {
  std::ostringstream all;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(VAT_SOURCE_DIR "/tests/server")) {
    if (entry.path().extension() == ".cpp") all << std::ifstream(entry.path()).rdbuf();
  }
  return all.str();
}

TEST(LimitTable, HasEveryLimitOfServerInfo) {
  const Json limits = limits_told({});
  std::set<std::string> told;
  for (const auto& [name, value] : limits.items()) told.insert(name);
  std::set<std::string> listed;
  for (const Limit& limit : limit_table()) {
    EXPECT_TRUE(listed.insert(limit.name).second) << limit.name;
  }
  EXPECT_EQ(told, listed);
}

// Sets all settings to different values. server.info must report each in its member.
TEST(LimitTable, ServerInfoHasTheValuesOfTheSettings) {
  ServeSettings settings;
  const std::vector<Setting> table = serve_settings(settings);
  std::map<std::string, double> chosen;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!table[i].is_number || kOtherGroups.contains(table[i].group)) continue;
    const Json value = to_json(table[i], to_text(chosen_value(table[i], chosen.size())));
    ASSERT_EQ(table[i].find_fault(value), "") << table[i].name;
    table[i].assign(value);
    chosen[table[i].name] = value;
  }
  const Json told = limits_told(settings);
  std::set<std::string> used;
  for (const Limit& limit : limit_table()) {
    if (limit.setting == nullptr) continue;
    ASSERT_TRUE(chosen.contains(limit.setting)) << limit.setting;
    EXPECT_DOUBLE_EQ(told.at(limit.name), chosen.at(limit.setting)) << limit.name;
    used.insert(limit.setting);
  }
  for (const auto& [name, value] : chosen) {
    EXPECT_TRUE(used.contains(name)) << name << " is in no limit of server.info";
  }
}

TEST(LimitTable, NamesTestsThatThereAre) {
  const std::string sources = sources_of_tests();
  for (const Limit& limit : limit_table()) {
    std::string test = limit.test;
    test.replace(test.find('.'), 1, ", ");
    EXPECT_NE(sources.find('(' + test + ')'), std::string::npos) << limit.name << ": " << test;
  }
}

}  // namespace
}  // namespace vat::test::limit_table_test
