#include "server/session/core/command_entry.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"

namespace vat {
namespace {

using EntryResult = std::variant<CommandEntry, RpcError>;

EntryResult make_load_entry(const SessionContext& context, const SessionHistory& history,
                            const ParticipantCommand& command) {
  const SessionEnvironment& environment = *context.environment;
  Json params = command.command.params;
  std::optional<SessionAction> action;
  Json& scene = params.at("scene");
  if (const Scene* named = scene.is_string()
                               ? environment.catalogue.find(scene.get_ref<const std::string&>())
                               : nullptr) {
    scene = write_scene(*named);
  } else if (scene.is_string()) {
    auto saved = find_saved_scene(scene.get_ref<const std::string&>(), environment);
    if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
    scene = std::get<Json>(std::move(saved));
    action = environment.methods.make(kLoadMethod, params).action;
  }
  return CommandEntry{history.make_entry(command.participant, kLoadMethod, params.dump()),
                      std::move(action)};
}

EntryResult make_restore_entry(const SessionContext& context, const SessionHistory& history,
                               const ParticipantCommand& command) {
  const auto& name = command.command.params.at("name").get_ref<const std::string&>();
  SavedStates* const states = context.environment->states;
  const auto state = states == nullptr ? std::nullopt : states->find(context.id, name);
  if (!state) return no_such_state(name);
  const Json params = params_of_restore(*state);
  return CommandEntry{history.make_entry(command.participant, kRestoreEntry, params.dump()),
                      read_restore(params)};
}

}  // namespace

EntryResult make_command_entry(const SessionContext& context, const SessionHistory& history,
                               const ParticipantCommand& command) {
  const std::string_view method = command.command.row->name;
  try {
    if (method == kLoadMethod) return make_load_entry(context, history, command);
    if (method == kLoadStateMethod) return make_restore_entry(context, history, command);
  } catch (const StorageError& error) {
    spdlog::error("session {}: {}", context.id, error.what());
    return storage_failed(error.kind());
  }
  return CommandEntry{
      history.make_entry(command.participant, method, command.command.params.dump()), {}};
}

}  // namespace vat
