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

CommandResolution resolve_scene(const SessionEnvironment& environment,
                                const SessionCommand& command) {
  auto saved = find_saved_scene(*scene_name(command), environment);
  if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
  Json params = command.params;
  params["scene"] = std::get<Json>(std::move(saved));
  std::string text = params.dump();
  return ResolvedCommand{std::move(text),
                         environment.methods.make(kLoadMethod, std::move(params)).action};
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
    if (const auto* error = std::get_if<RpcError>(command.resolution.get())) return *error;
    const auto& resolved = std::get<ResolvedCommand>(*command.resolution);
    const std::string_view entry_method = method == kLoadMethod ? kLoadMethod : kRestoreEntry;
    return CommandEntry{history.make_entry(participant, entry_method, resolved.params),
                        resolved.action};
  }
  if (method == kLoadMethod && scene_name(command) != nullptr) {
    Json params = command.params;
    params["scene"] = write_scene(*environment.catalogue.find(*scene_name(command)));
    return CommandEntry{history.make_entry(participant, method, params.dump()), {}};
  }
  return CommandEntry{history.make_entry(participant, method, command.params.dump()), {}};
}

}  // namespace vat
