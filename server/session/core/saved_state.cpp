#include "server/session/core/saved_state.h"

#include <utility>

#include "core/device/device_use.h"
#include "core/limits.h"
#include "server/session/core/scene_loading.h"
#include "server/storage/sqlite/compression.h"
#include "server/support/base64.h"

namespace vat {
namespace {

/// A state that is restored, as its entry tells it.
// NOLINTNEXTLINE(bugprone-exception-escape): the library says that moves of JSON do not throw
struct Restore {
  Json scene;
  std::uint64_t tick = 0;
  std::vector<std::uint64_t> grabs;
  std::vector<std::uint8_t> state;  ///< compressed
};

[[noreturn]] void fail(const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, "a saved state: " + why);
}

Restore read(const Json& params) {
  Errors errors;
  ObjectReader reader(params, "", errors);
  Restore restore;
  if (const Json* scene = reader.member("scene", true)) restore.scene = *scene;
  restore.tick = reader.count("tick", 0, kMaxExactCount);
  if (const Json* grabs = reader.array("grabs", kMaxGrabs, true)) {
    for (const Json& grab : *grabs) {
      const auto id = to_count(grab, "/grabs", 0, kMaxExactCount, errors);
      if (id) restore.grabs.push_back(*id);
    }
  }
  const Json* state = reader.member("state", true);
  if (!errors.empty()) fail(errors.front().path + " " + errors.front().message);
  if (!state->is_string()) fail("/state must be text");
  auto bytes = from_base64(state->get_ref<const std::string&>());
  if (!bytes) fail("/state must be base64");
  restore.state = *std::move(bytes);
  return restore;
}

ActionResult execute_restore(const Restore& restore, SessionCore& core) {
  const SessionEnvironment& environment = core.environment();
  const InstructionSet instructions = core.run().simulation().instruction_set();
  Result<Simulation> loaded =
      Simulation::load(decompress(restore.state, max_state_bytes(environment.limits)),
                       &environment.runner, instructions);
  if (!loaded) fail(loaded.errors().front().message);
  Simulation simulation = std::move(loaded).value();
  if (auto excess = find_excess(simulation, environment.limits)) return *std::move(excess);
  auto scene = read_client_scene(restore.scene, environment.catalogue);
  if (const auto* error = std::get_if<RpcError>(&scene)) fail(error->message);
  auto made = make_simulation(std::get<Scene>(scene), environment, instructions);
  if (auto* error = std::get_if<RpcError>(&made)) return std::move(*error);
  const auto& as_loaded = std::get<Simulation>(made);
  const DeviceChoice device = device_of(as_loaded.scene(), environment);
  if (const Status used = resume_device(device, simulation); !used) {
    return not_allowed("the state needs its device: " + used.errors().front().message);
  }
  if (const auto excess = core.run().admit(simulation, as_loaded)) return limit_reached(*excess);
  for (const std::uint64_t grab : restore.grabs) {
    if (!simulation.grab_end(grab)) fail("a grab is missing");
  }
  core.restore(std::move(simulation), as_loaded, restore.tick);
  return Json::object();
}

}  // namespace

MomentToSave moment_to_save(SessionCore& core) {
  MomentToSave moment{
      core.run().simulation().snapshot(), core.run().as_loaded(), core.run().tick(), {}};
  for (const auto& [number, participant] : core.participants().all()) {
    for (const auto& [grab, body] : participant.grabs) moment.grabs.push_back(grab);
  }
  return moment;
}

SavedState make_saved_state(const MomentToSave& moment, const std::string& name,
                            const std::string& saved_by, double wall_time) {
  const std::vector<std::uint8_t> bytes = moment.present.to_bytes();
  const Result<Simulation> simulation = Simulation::load(bytes);
  if (!simulation) fail(simulation.errors().front().message);
  SavedState state;
  state.entry.name = name;
  state.entry.saved_by = saved_by;
  state.entry.time = wall_time;
  state.entry.tick = moment.tick;
  state.entry.simulation_time = simulation.value().time();
  state.entry.hash = moment.present.state_hash();
  state.fields = Json{
      {"scene", write_scene(moment.as_loaded.scene())},
      {"tick", moment.tick},
      {"grabs",
       moment.grabs}}.dump();
  state.state = compress(bytes);
  state.entry.bytes = state.fields.size() + state.state.size();
  return state;
}

Json params_of_restore(const SavedState& state) {
  Result<Json> fields =
      parse_json(state.fields, {state.fields.size(), kMaxMessageDepth, state.fields.size() + 1});
  if (!fields) fail(fields.errors().front().message);
  Json params = std::move(fields).value();
  if (!params.is_object()) fail("no object");
  params["name"] = state.entry.name;
  params["state"] = to_base64(state.state);
  return params;
}

SessionAction read_restore(const Json& params) {
  return [restore = read(params)](SessionCore& core, Participant&) {
    return execute_restore(restore, core);
  };
}

}  // namespace vat
