#include "server/replay/log_replay.h"

#include <optional>
#include <string>
#include <utility>

#include "core/device/device_use.h"
#include "core/support/check.h"
#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

std::string name_of(const LogEntry& entry) {
  return "entry " + std::to_string(entry.sequence) + " (" + entry.method + ")";
}

[[noreturn]] void fail_entry(const LogEntry& entry, const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, name_of(entry) + ": " + why);
}

SessionCommand read_command(const SessionCore& core, const LogEntry& entry) {
  auto command = core.environment().methods.parse(entry.method, parse_entry_params(entry));
  if (const auto* errors = std::get_if<Errors>(&command)) {
    fail_entry(entry, errors->front().path + " " + errors->front().message);
  }
  auto& parsed = std::get<SessionCommand>(command);
  if (!parsed.row->is_logged()) fail_entry(entry, "the method is not logged");
  return std::move(parsed);
}

/// A refused body has used an id all the same.
void repeat_refused(SessionCore& core, const LogEntry& entry) {
  if (entry.method != "world.add_body") return;
  const Snapshot before = core.run().simulation().snapshot();
  core.execute(entry, read_command(core, entry).action);
  core.run().simulation().restore(before);
}

}  // namespace

Json parse_entry_params(const LogEntry& entry) {
  Result<Json> json =
      parse_json(entry.params, {entry.params.size(), kMaxMessageDepth, entry.params.size() + 1});
  if (!json) fail_entry(entry, json.errors().front().message);
  return std::move(json).value();
}

Simulation load_entry_scene(const LogEntry& entry, const SessionEnvironment& environment,
                            InstructionSet instructions) {
  const Json params = parse_entry_params(entry);
  const auto value = params.find("scene");
  if (value == params.end()) fail_entry(entry, "it has no scene");
  const Json name = params.value("level", Json(to_string(Level::normal)));
  const std::optional<Level> level =
      name.is_string() ? find_level(name.get_ref<const std::string&>()) : std::nullopt;
  if (!level) fail_entry(entry, "it has an unknown level");
  const auto scene = read_client_scene(*value, environment.catalogue, *level);
  if (const auto* error = std::get_if<RpcError>(&scene)) fail_entry(entry, error->message);
  auto simulation = make_simulation(std::get<Scene>(scene), environment, instructions);
  if (const auto* error = std::get_if<RpcError>(&simulation)) fail_entry(entry, error->message);
  return std::get<Simulation>(std::move(simulation));
}

void resume_on_device(Simulation& simulation, const Scene& scene,
                      const SessionEnvironment& environment) {
  const DeviceChoice device = device_of(scene, environment);
  const Status resumed = resume_device(device, simulation);
  if (resumed) return;
  throw StorageError(StorageError::Kind::failed,
                     "its device is not available: " + resumed.errors().front().message +
                         "; with --device cpu, the CPU continues, with other bits");
}

void repeat_entry(SessionCore& core, const LogEntry& entry) {
  if (entry.method == kLeaveEntry) return core.people().execute_leave(entry);
  if (entry.method == kReleaseGrabsEntry) return core.people().execute_release(entry);
  if (entry.refused) return repeat_refused(core, entry);
  const bool restores = entry.method == kRestoreEntry;
  const SessionAction action =
      restores ? read_restore(parse_entry_params(entry)) : read_command(core, entry).action;
  const ActionResult result = core.execute(entry, action);
  if (const auto* error = std::get_if<RpcError>(&result)) {
    throw Diverged(name_of(entry) + " is refused: " + error->message);
  }
}

void repeat_recorded_entry(SessionCore& core, const LogEntry& entry) {
  const MethodRow* row = core.environment().methods.find(entry.method);
  if (row == nullptr || row->logging != Logging::clock) return repeat_entry(core, entry);
  core.execute(entry, [](SessionCore&, Participant&) -> ActionResult { return Json::object(); });
}

void run_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled) {
  while (core.run().position() < position) {
    if (cancelled) throw Cancelled();
    if (core.tick(core.environment().clock.now(), false)) continue;
    throw Diverged("the tick after " + std::to_string(core.run().tick()) + " fails");
  }
  VAT_CHECK(core.run().position() >= position);
}

}  // namespace vat
