// session.save, load, saves, delete_save, scene.save, scene.delete

#include <stdexcept>

#include "protocol/messages/describe.h"
#include "server/methods/handlers.h"
#include "server/people/person_name.h"
#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"
#include "server/session/session_archive.h"
#include "server/storage/saved/saved_scenes.h"

namespace vat {
namespace {

/// Request to save a scene.
struct SceneToSave {
  std::string name;
  std::string key;    ///< of the replaced scene; empty: none
  const Json* scene;  ///< null: the session's scene
};

std::variant<Scene, RpcError> scene_to_save(const SessionCore& core, const SceneToSave& wanted) {
  if (wanted.scene == nullptr) return core.run().as_loaded().scene();
  auto scene = read_client_scene(*wanted.scene, core.environment().catalogue);
  if (auto* error = std::get_if<RpcError>(&scene)) return std::move(*error);
  // A scene that this server cannot run is not saved.
  auto simulation = make_simulation(std::get<Scene>(scene), core.environment(),
                                    core.run().simulation().instruction_set());
  if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
  return scene;
}

/// Returns whether a user with this key or role may replace or delete a scene.
SavedScenes::MayChange permission_of(const std::string& key, Role role) {
  return [key, role](const SceneKey& of_scene) {
    return role == Role::admin || are_same(of_scene, hash_of_token(key));
  };
}

RpcError scene_of_another(const std::string& name) {
  return not_allowed("the scene " + name +
                     " belongs to another user; only its key or an admin can change it");
}

SavedSceneLimits limits_of(const ServerLimits& limits) {
  return {limits.max_scenes_per_address, limits.max_scene_bytes_per_address,
          limits.max_scenes_in_all, limits.max_scene_bytes_in_all};
}

/// Writes a scene, which replaces a scene of this name if the key or the role permits it. Called on
/// a storage thread.
RpcResult write_saved_scene(const SessionEnvironment& environment, SavedScene saved,
                            const std::string& replaced_key, Role role) {
  const std::string name = saved.entry.name;
  const std::size_t bytes = saved.scene.size();
  const std::string key = make_token();
  saved.key = hash_of_token(key);
  const auto written = environment.scenes->write(std::move(saved), limits_of(environment.limits),
                                                 permission_of(replaced_key, role));
  if (const auto* excess = std::get_if<LimitExcess>(&written)) return limit_reached(*excess);
  const SceneChange change = std::get<SceneChange>(written);
  if (change == SceneChange::refused) return scene_of_another(name);
  Json answer{{"name", name}, {"bytes", bytes}};
  if (change == SceneChange::added) answer["key"] = key;
  return answer;
}

ActionResult save_scene(const SessionCore& core, const Participant& participant,
                        const SceneToSave& wanted) {
  const SessionEnvironment& environment = core.environment();
  if (environment.catalogue.find(wanted.name) != nullptr) {
    return not_allowed("the catalogue contains a scene with this name");
  }
  auto read = scene_to_save(core, wanted);
  if (auto* error = std::get_if<RpcError>(&read)) return std::move(*error);
  auto& scene = std::get<Scene>(read);
  scene.name = wanted.name;
  SavedScene saved;
  saved.entry = {wanted.name,
                 scene.title,
                 scene.description,
                 participant.name,
                 environment.clock.wall_time(),
                 0};
  saved.address = participant.outbox->address();
  saved.scene = write_scene(scene).dump();
  return StorageWork{
      [&environment, saved = std::move(saved), key = wanted.key, role = participant.role] {
        return write_saved_scene(environment, saved, key, role);
      }};
}

RpcResult delete_scene(SavedScenes& scenes, const std::string& name, const std::string& key,
                       Role role) {
  const SceneChange change = scenes.remove(name, permission_of(key, role));
  if (change == SceneChange::absent) return no_such_scene(name, "/name");
  if (change == SceneChange::refused) return scene_of_another(name);
  return Json::object();
}

RpcResult list_states(SavedStates& states, const SessionId& session) {
  Json list = Json::array();
  for (const SavedStateEntry& entry : states.list(session)) {
    list.push_back({{"name", entry.name},
                    {"saved_by", entry.saved_by},
                    {"saved", entry.time},
                    {"at_tick", entry.tick},
                    {"time", entry.simulation_time},
                    {"hash", describe_hash(entry.hash)},
                    {"bytes", entry.bytes}});
  }
  return Json{{"states", std::move(list)}};
}

RpcResult delete_state(SavedStates& states, const SessionId& session, const std::string& name) {
  if (!states.remove(session, name)) return no_such_state(name);
  return Json::object();
}

}  // namespace

SessionAction read_session_save(ObjectReader& params, Errors& errors) {
  const std::string name = read_person_name(params, "name", errors);
  return [name](SessionCore& core, Participant& participant) -> ActionResult {
    if (core.playback() != nullptr) return not_allowed("a replay saves no states");
    if (core.history().divergence()) return not_allowed("the session differs from its log");
    return StorageWork{[&environment = core.environment(), session = core.id(),
                        moment = moment_to_save(core), name, saved_by = participant.name] {
      return save_state(environment, session, moment, name, saved_by);
    }};
  };
}

SessionAction read_session_load(ObjectReader& params, Errors& errors) {
  read_person_name(params, "name", errors);
  return [](SessionCore&, Participant&) -> ActionResult {
    throw std::logic_error("session.load is executed by its log entry");
  };
}

SessionAction read_session_saves(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    return StorageWork{[states = core.environment().states, session = core.id()] {
      return list_states(*states, session);
    }};
  };
}

SessionAction read_session_delete_save(ObjectReader& params, Errors& errors) {
  const std::string name = read_person_name(params, "name", errors);
  return [name](SessionCore& core, Participant&) -> ActionResult {
    return StorageWork{[states = core.environment().states, session = core.id(), name] {
      return delete_state(*states, session, name);
    }};
  };
}

SessionAction read_scene_save(ObjectReader& params, Errors& errors) {
  SceneToSave wanted{read_person_name(params, "name", errors), "", nullptr};
  if (params.has("key")) wanted.key = params.text("key", kMaxTokenBytes);
  const Json* given = params.member("scene");
  if (given != nullptr && !given->is_object()) {
    add_error(errors, "wrong_type", params.path_of("scene"), "must be a scene, not a name");
  }
  const std::optional<Json> scene = given == nullptr ? std::nullopt : std::optional(*given);
  return [wanted, scene](SessionCore& core, Participant& participant) {
    return save_scene(core, participant, {wanted.name, wanted.key, scene ? &*scene : nullptr});
  };
}

ServerAction read_scene_delete(ObjectReader& params, Errors& errors) {
  const std::string name = read_person_name(params, "name", errors);
  std::string key;
  if (params.has("key")) key = params.text("key", kMaxTokenBytes);
  return [name, key](SessionDirectory& directory, PendingReply& reply) -> std::optional<RpcResult> {
    const Role role = directory.find_client(reply.client()->id()).role;
    directory.use_storage(reply, [&scenes = *directory.resources().environment.scenes, name, key,
                                  role] { return delete_scene(scenes, name, key, role); });
    return {};
  };
}

}  // namespace vat
