// state.*, session.hash, session.stats, recording.export

#include <chrono>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/limits.h"
#include "server/messages/describe.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

std::vector<BodyKey> read_keys(const Json& list, const std::string& path, Errors& errors) {
  std::vector<BodyKey> keys;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto key = to_body_key(list[i], pointer_to(path, i), errors)) {
      keys.push_back(*std::move(key));
    }
  }
  return keys;
}

/// Without keys: all bodies.
ActionResult query(const Simulation& simulation, const std::optional<std::vector<BodyKey>>& keys) {
  Json bodies = Json::array();
  if (!keys) {
    for (const BodyView& body : simulation.bodies()) bodies.push_back(describe_state(body));
  } else {
    for (std::size_t i = 0; i < keys->size(); ++i) {
      const auto body = find_body(simulation, (*keys)[i]);
      if (!body) return no_body_with_key(pointer_to("/bodies", i));
      bodies.push_back(describe_state(*body));
    }
  }
  return Json{{"time", simulation.time()}, {"bodies", std::move(bodies)}};
}

double to_seconds(TickProfile::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

Json describe_stages(const std::vector<StageClock::Stage>& stages) {
  Json list = Json::array();
  for (const StageClock::Stage& stage : stages) {
    list.push_back({{"stage", stage.name}, {"calls", stage.calls}, {"seconds", stage.seconds()}});
  }
  return list;
}

}  // namespace

SessionAction read_state_query(ObjectReader& params, Errors& errors) {
  std::optional<std::vector<BodyKey>> keys;
  if (const Json* list = params.array("bodies", kMaxBodies)) {
    keys = read_keys(*list, params.path_of("bodies"), errors);
  }
  return [keys](SessionCore& core, Participant&) { return query(core.run().simulation(), keys); };
}

/// Bodies by id or name; all if no key is given.
SessionAction read_state_connections(ObjectReader& params, Errors& errors) {
  std::optional<BodyKey> key;
  if (const Json* body = params.member("body")) {
    key = to_body_key(*body, params.path_of("body"), errors);
  }
  const std::size_t most = params.count("most", 1, kMaxConnections, kDefaultConnections);
  return [key, most](SessionCore& core, Participant&) -> ActionResult {
    const Simulation& simulation = core.run().simulation();
    ConnectionQuery wish{{}, most};
    if (key) {
      const auto body = find_body(simulation, *key);
      if (!body) return no_body_with_key("/body");
      wish.body = body->id;
    }
    const Result<Connections> found = simulation.connections(wish);
    if (!found) return refused(found.errors());
    return Json{{"time", simulation.time()},
                {"springs", describe_connections(found.value().springs, "strains")},
                {"contacts", describe_connections(found.value().contacts, "forces")}};
  };
}

SessionAction read_session_hash(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    const Simulation& simulation = core.run().simulation();
    return Json{{"hash", describe_hash(simulation.state_hash())},
                {"instruction_set", to_string(simulation.instruction_set())},
                {"time", simulation.time()},
                {"position", core.run().position()}};
  };
}

SessionAction read_session_stats(ObjectReader& params, Errors&) {
  const bool with_diagnostics = params.boolean("diagnostics", false);
  return [with_diagnostics](SessionCore& core, Participant&) -> ActionResult {
    const Simulation& simulation = core.run().simulation();
    const TickProfile::Totals& totals = core.run().profile().totals();
    Json stats{{"instruction_set", to_string(simulation.instruction_set())},
               {"threads", core.environment().runner.thread_count()},
               {"time", simulation.time()},
               {"real_time_factor", core.clock().rate()},
               {"particles", simulation.particle_count()},
               {"sleeping_bodies", simulation.sleeping_body_count()},
               {"ticks", totals.ticks},
               {"substeps", totals.substeps},
               {"undone_substeps", totals.undone_substeps},
               {"seconds", to_seconds(totals.time)},
               {"longest_tick", to_seconds(totals.longest_tick)},
               {"stages", describe_stages(totals.stages)}};
    if (with_diagnostics) stats["diagnostics"] = describe_diagnostics(simulation.diagnostics());
    return stats;
  };
}

SessionAction read_recording_export(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    if (core.playback() != nullptr) return not_allowed("the session is itself a replay");
    if (core.history().log() == nullptr)
      return not_allowed("the server stores no sessions; see --data");
    if (core.history().divergence()) return not_allowed("the session differs from its log");
    return MakeRecording{};
  };
}

}  // namespace vat
