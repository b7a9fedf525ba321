#include "server/session/core/command_entry.h"

#include <utility>

#include "core/support/check.h"
#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {
namespace {

/// Returns the name in the parameter `scene` of scene.load, or null if it is a scene.
const std::string* scene_name(const SessionCommand& command) {
  const Json& scene = command.params.at("scene");
  return scene.is_string() ? &scene.get_ref<const std::string&>() : nullptr;
}

/// Replaces the parameter `scene` of scene.load, and chooses the device of the scene.
CommandResolution resolve_device(const SessionEnvironment& environment,
                                 const SessionCommand& command, Json scene) {
  Json given = command.params;
  given["scene"] = std::move(scene);
  auto params = with_device(std::move(given), environment);
  if (auto* error = std::get_if<RpcError>(&params)) return std::move(*error);
  std::string text = std::get<Json>(params).dump();
  return ResolvedCommand{
      std::move(text),
      environment.methods.make(kLoadMethod, std::get<Json>(std::move(params))).action};
}

CommandResolution resolve_scene(const SessionEnvironment& environment,
                                const SessionCommand& command) {
  auto saved = find_saved_scene(*scene_name(command), environment);
  if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
  return resolve_device(environment, command, std::get<Json>(std::move(saved)));
}

std::variant<CommandEntry, RpcError> to_entry(const CommandResolution& resolution,
                                              const SessionHistory& history,
                                              ParticipantNumber participant,
                                              std::string_view method) {
  if (const auto* error = std::get_if<RpcError>(&resolution)) return *error;
  const auto& resolved = std::get<ResolvedCommand>(resolution);
  return CommandEntry{history.make_entry(participant, method, resolved.params), resolved.action};
}

CommandResolution resolve_state(const SessionEnvironment& environment, const std::string& session,
                                const SessionCommand& command) {
  const auto& name = command.params.at("name").get_ref<const std::string&>();
  SavedStates* const states = environment.states;
  const auto state = states == nullptr ? std::nullopt : states->find(session, name);
  if (!state) return no_such_state(name);
  const Json params = params_of_restore(*state);
  return ResolvedCommand{params.dump(), read_restore(params)};
}

}  // namespace

bool names_saved_data(const SessionEnvironment& environment, const SessionCommand& command) {
  const std::string_view method = command.row->name;
  if (method == kLoadStateMethod) return true;
  if (method != kLoadMethod) return false;
  const std::string* const name = scene_name(command);
  return name != nullptr && environment.catalogue.find(*name) == nullptr;
}

CommandResolution resolve_command(const SessionEnvironment& environment, const std::string& session,
                                  const SessionCommand& command) {
  try {
    if (command.row->name == kLoadMethod) return resolve_scene(environment, command);
    return resolve_state(environment, session, command);
  } catch (const StorageError& error) {
    log_error("session {}: {}", session, error.what());
    return storage_failed(error.kind());
  } catch (const std::exception& error) {
    log_error("session {}: {}", session, error.what());
    return internal_error();
  }
}

std::variant<CommandEntry, RpcError> make_command_entry(const SessionEnvironment& environment,
                                                        const SessionHistory& history,
                                                        const ParticipantCommand& of_participant) {
  const auto& [participant, command] = of_participant;
  const std::string_view method = command.row->name;
  if (names_saved_data(environment, command)) {
    VAT_CHECK(command.resolution != nullptr);
    const std::string_view entry_method = method == kLoadMethod ? kLoadMethod : kRestoreEntry;
    return to_entry(*command.resolution, history, participant, entry_method);
  }
  if (method == kLoadMethod) {
    const std::string* const name = scene_name(command);
    const Json scene = name == nullptr ? command.params.at("scene")
                                       : write_scene(*environment.catalogue.find(*name));
    return to_entry(resolve_device(environment, command, scene), history, participant, method);
  }
  return CommandEntry{history.make_entry(participant, method, command.params.dump()), {}};
}

}  // namespace vat
