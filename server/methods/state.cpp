// state.*, session.hash, session.stats, recording.export

#include <chrono>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/limits.h"
#include "protocol/messages/describe.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"
#include "server/session/core/session_view.h"

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
RpcResult query(const Simulation& simulation, const std::optional<std::vector<BodyKey>>& keys) {
  Json bodies = Json::array();
  if (!keys) {
    for (const BodyView& body : simulation.bodies()) bodies.push_back(describe_state(body));
  } else {
    for (std::size_t i = 0; i < keys->size(); ++i) {
      const auto body = find_body(simulation, (*keys)[i]);
      if (!body) return no_body_with_key(simulation, (*keys)[i], pointer_to("/bodies", i));
      bodies.push_back(describe_state(*body));
    }
  }
  return Json{{"time", simulation.time()}, {"bodies", std::move(bodies)}};
}

/// Returns an action whose result is computed from the state of the session.
SessionAction read_later(std::function<RpcResult(SessionView&)> make) {
  return [make = std::move(make)](SessionCore&, Participant&) -> ActionResult {
    return Read{true, make, {}};
  };
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
  return read_later([keys](SessionView& view) { return query(view.simulation(), keys); });
}

/// Bodies by id or name; all if no key is given.
SessionAction read_state_connections(ObjectReader& params, Errors& errors) {
  std::optional<BodyKey> key;
  if (const Json* body = params.member("body")) {
    key = to_body_key(*body, params.path_of("body"), errors);
  }
  const std::size_t most = params.count("most", 1, kMaxConnections, kDefaultConnections);
  return read_later([key, most](SessionView& view) -> RpcResult {
    const Simulation& simulation = view.simulation();
    ConnectionQuery wish{{}, most};
    if (key) {
      const auto body = find_body(simulation, *key);
      if (!body) return no_body_with_key(simulation, *key, "/body");
      wish.body = body->id;
    }
    const Result<Connections> found = simulation.connections(wish);
    if (!found) return refused(found.errors());
    return Json{{"time", simulation.time()},
                {"springs", describe_connections(found.value().springs, "strains")},
                {"contacts", describe_connections(found.value().contacts, "forces")}};
  });
}

SessionAction read_session_hash(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    const DeviceChoice device = core.run().device();
    return Read{true,
                [device](SessionView& view) -> RpcResult {
                  Json content{{"hash", describe_hash(view.snapshot().state_hash())},
                               {"instruction_set", to_string(view.snapshot().instruction_set())},
                               {"time", view.time()},
                               {"position", view.position()}};
                  if (!device.is_cpu) content["device"] = to_text(device);
                  return content;
                },
                to_text(device)};
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
    if (const DeviceChoice device = core.run().device(); !device.is_cpu) {
      stats["device"] = to_text(device);
      stats["device_steps"] = totals.device_steps;
    }
    if (!with_diagnostics) return stats;
    return Read{true,
                [stats](SessionView& view) -> RpcResult {
                  Json content = stats;
                  content["diagnostics"] = describe_diagnostics(view.simulation().diagnostics());
                  return content;
                },
                stats.dump()};
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
