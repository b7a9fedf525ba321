// server.*, scene.list

#include <chrono>

#include "core/limits.h"
#include "server/methods/handlers.h"

namespace vat {
namespace {

double seconds(std::chrono::milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// Limits of recordings, saved states and saved scenes.
Json describe_limits_of_kept(const ServerLimits& limits) {
  return {
      {"recording_bytes", limits.max_recording_bytes},
      {"recording_ticks", kMaxRecordedTicks},
      {"recording_entries", kMaxRecordedEntries},
      {"download_bytes", limits.max_download_bytes},
      {"imports", Imports::kMaxFiles},
      {"import_bytes", Imports::kMaxBytes},
      {"states_per_session", limits.max_states_per_session},
      {"state_bytes_per_session", limits.max_state_bytes_per_session},
      {"state_bytes_in_all", limits.max_state_bytes_in_all},
      {"scenes_per_address", limits.max_scenes_per_address},
      {"scene_bytes_per_address", limits.max_scene_bytes_per_address},
      {"scenes_in_all", limits.max_scenes_in_all},
      {"scene_bytes_in_all", limits.max_scene_bytes_in_all},
  };
}

Json describe_limits(const ServerLimits& limits) {
  Json all{
      {"connections", limits.max_connections},
      {"connections_per_address", limits.max_connections_per_address},
      {"sessions", limits.max_sessions},
      {"sessions_per_address", limits.max_sessions_per_address},
      {"replays", limits.max_replays},
      {"clients_per_session", limits.max_clients_per_session},
      {"particles", limits.max_particles},
      {"springs", limits.max_springs},
      {"particles_in_all", limits.max_particles_in_all},
      {"springs_in_all", limits.max_springs_in_all},
      {"particle_steps_per_tick", limits.max_particle_steps_per_tick},
      {"message_bytes", limits.max_message_bytes},
      {"scene_message_bytes", limits.max_scene_message_bytes},
      {"message_depth", limits.max_message_depth},
      {"message_values", limits.max_message_values},
      {"commands_in_flight", limits.max_commands_in_flight},
      {"command_bytes_in_flight", limits.max_bytes_in_flight},
      {"queries_per_second", limits.max_queries_per_second},
      {"controls_per_second", limits.max_controls_per_second},
      {"pointer_moves_per_second", limits.max_pointer_moves_per_second},
      {"scenes_per_second", limits.max_scenes_per_second},
      {"reads_per_second", limits.max_reads_per_second},
      {"read_bytes_per_second", limits.max_read_bytes_per_second},
      {"read_seconds_per_second", limits.max_read_seconds_per_second},
      {"session_read_bytes_per_second", limits.max_session_read_bytes_per_second},
      {"session_read_seconds_per_second", limits.max_session_read_seconds_per_second},
      {"message_bytes_per_second", limits.max_message_bytes_per_second},
      {"queue_bytes_in_all", limits.max_queue_bytes_in_all},
      {"memory_bytes", limits.max_memory},
      {"burst_seconds", limits.burst_seconds},
      {"refusals_per_second", limits.max_refusals_per_second},
      {"grabs_per_client", limits.max_grabs_per_client},
      {"grabs_per_session", kMaxGrabs},
      {"applied_forces", kMaxAppliedForces},
      {"bodies", kMaxBodies},
      {"name_bytes", kMaxNameLength},
      {"ticks_per_step", kMaxTicksPerStep},
      {"frame_window", kFrameWindow},
      {"frame_groups", kMaxFrameGroups},
      {"frame_patience_seconds", limits.frame_patience.count()},
      {"grab_idle_seconds", seconds(limits.grab_idle)},
      {"presence", kMaxPresence},
      {"connections_listed", kMaxConnections},
      {"tokens", limits.max_tokens},
      {"resume_seconds", seconds(limits.resume_time)},
      {"handshake_seconds", seconds(limits.handshake_time)},
      {"ping_seconds", seconds(limits.ping_interval)},
      {"hibernate_after_seconds", seconds(limits.hibernate_after)},
      {"expire_after_seconds", seconds(limits.expire_after)},
      {"replay_expire_after_seconds", seconds(limits.replay_expire_after)},
      {"control_queue_bytes", limits.max_control_queue_bytes},
  };
  all.update(describe_limits_of_kept(limits));
  return all;
}

std::optional<RpcResult> info(const SessionDirectory& directory) {
  Json methods = Json::array();
  for (const std::string_view name : directory.resources().environment.methods.names) {
    methods.push_back(name);
  }
  Json info{
      {"name", "vat"},
      {"version", directory.resources().settings.version},
      {"protocol", "vat.v1"},
      {"instruction_set", to_string(directory.resources().settings.instructions)},
      {"access", to_string(directory.resources().settings.access.mode)},
      {"storage", directory.resources().settings.data_folder.empty() ? "memory" : "folder"},
      {"time", directory.resources().clock.wall_time()},
      {"limits", describe_limits(directory.resources().settings.limits)},
      {"methods", std::move(methods)},
  };
  if (const auto& cluster = directory.resources().cluster) {
    info["node"] = cluster->name();
    info["nodes"] = cluster->urls();
  }
  return info;
}

RpcResult list_scenes(const ServerResources& resources) {
  Json scenes = Json::array();
  for (const CatalogueEntry& entry : resources.catalogue.entries()) {
    scenes.push_back(
        {{"name", entry.name}, {"title", entry.title}, {"description", entry.description}});
  }
  for (const SavedSceneEntry& entry : resources.environment.scenes->list()) {
    if (resources.catalogue.find(entry.name) != nullptr) continue;  // it has got one since
    scenes.push_back({{"name", entry.name},
                      {"title", entry.title},
                      {"description", entry.description},
                      {"saved_by", entry.saved_by},
                      {"saved", entry.time}});
  }
  return Json{{"scenes", std::move(scenes)}};
}

}  // namespace

ServerAction read_server_info(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply&) { return info(directory); };
}

ServerAction read_scene_list(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& reply) -> std::optional<RpcResult> {
    directory.use_storage(reply,
                          [&resources = directory.resources()] { return list_scenes(resources); });
    return {};
  };
}

}  // namespace vat
