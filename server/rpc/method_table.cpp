#include "server/rpc/method_table.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr auto kNoLog = Logging::none;
constexpr auto kClock = Logging::clock;
constexpr auto kScene = Logging::scene;

// clang-format off
constexpr auto kMethods = [] {
  using enum Role;
  using enum RoleSource;
  using enum RateClass;
  return std::to_array<Method>({
    // name, least role, whose role, rate class, logged as, handler
    {"server.info",          none,       connection,  query,   kNoLog, read_server_info},
    {"scene.list",           viewer,     connection,  query,   kNoLog, read_scene_list},
    {"scene.levels",         viewer,     connection,  query,   kNoLog, read_scene_levels},
    {"scene.get",            viewer,     participant, scene,   kNoLog, read_scene_get},
    {"session.create",       controller, connection,  scene,   kNoLog, read_session_create},
    {"session.list",         viewer,     connection,  query,   kNoLog, read_session_list},
    {"session.join",         viewer,     connection,  control, kNoLog, read_session_join},
    {"session.leave",        viewer,     connection,  control, kNoLog, read_session_leave},
    {"session.close",        owner,      named,       control, kNoLog, read_session_close},
    {"scene.load",           controller, participant, scene,   kScene, read_scene_load},
    {"control.play",         controller, participant, control, kClock, read_control_play},
    {"control.pause",        controller, participant, control, kClock, read_control_pause},
    {"control.step",         controller, participant, control, kClock, read_control_step},
    {"control.reset",        controller, participant, control, kScene, read_control_reset},
    {"control.set_speed",    controller, participant, control, kClock, read_control_set_speed},
    {"world.add_body",       controller, participant, scene,   kScene, read_world_add_body},
    {"world.remove_body",    controller, participant, control, kScene, read_world_remove_body},
    {"world.melt_body",      controller, participant, control, kScene, read_world_melt_body},
    {"world.set_emitter",    controller, participant, control, kScene, read_world_set_emitter},
    {"world.set_gravity",    controller, participant, pointer, kScene, read_world_set_gravity},
    {"world.set_interface",  controller, participant, control, kScene, read_world_set_interface},
    {"world.apply_force",    controller, participant, control, kScene, read_world_apply_force},
    {"world.move_body",      controller, participant, pointer, kScene, read_world_move_body},
    {"world.set_material",   controller, participant, control, kScene, read_world_set_material},
    {"world.set_numerics",   controller, participant, control, kScene, read_world_set_numerics},
    {"world.move_vat",       controller, participant, pointer, kScene, read_world_move_vat},
    {"grab.start",           controller, participant, control, kScene, read_grab_start},
    {"grab.move",            controller, participant, pointer, kScene, read_grab_move},
    {"grab.end",             controller, participant, control, kScene, read_grab_end},
    {"frames.subscribe",     viewer,     participant, control, kNoLog, read_frames_subscribe},
    {"frames.unsubscribe",   viewer,     participant, control, kNoLog, read_frames_unsubscribe},
    {"frames.ack",           viewer,     connection,  query,   kNoLog, read_frames_ack},
    {"state.query",          viewer,     participant, read,    kNoLog, read_state_query},
    {"state.connections",    viewer,     participant, read,    kNoLog, read_state_connections},
    {"session.hash",         viewer,     participant, query,   kNoLog, read_session_hash},
    {"session.stats",        viewer,     participant, query,   kNoLog, read_session_stats},
    {"recording.export",     controller, participant, scene,   kNoLog, read_recording_export},
    {"session.configure",    owner,      participant, control, kNoLog, read_session_configure},
    {"session.invite",       owner,      participant, control, kNoLog, read_session_invite},
    {"participant.rename",   viewer,     participant, control, kNoLog, read_participant_rename},
    {"participant.set_role", owner,      participant, control, kNoLog, read_participant_set_role},
    {"participant.kick",     owner,      participant, control, kNoLog, read_participant_kick},
    {"control.request",      viewer,     participant, control, kNoLog, read_control_request},
    {"control.hand_over",    controller, participant, control, kNoLog, read_control_hand_over},
    {"presence.list",        viewer,     participant, query,   kNoLog, read_presence_list},
    {"presence.point",       viewer,     participant, pointer, kNoLog, read_presence_point},
    {"access.enter",         none,       connection,  control, kNoLog, read_access_enter},
    {"access.ticket",        owner,      named,       control, kNoLog, read_access_ticket},
    {"recording.import",     controller, connection,  scene,   kNoLog, read_recording_import},
    {"replay.open",          controller, named,       scene,   kNoLog, read_replay_open},
    {"replay.info",          viewer,     participant, query,   kNoLog, read_replay_info},
    {"replay.seek",          controller, participant, control, kNoLog, read_replay_seek},
    {"session.save",         controller, participant, scene,   kNoLog, read_session_save},
    {"session.load",         controller, participant, scene,   kScene, read_session_load},
    {"session.saves",        viewer,     participant, query,   kNoLog, read_session_saves},
    {"session.delete_save",  controller, participant, control, kNoLog, read_session_delete_save},
    {"scene.save",           controller, participant, scene,   kNoLog, read_scene_save},
    {"scene.delete",         controller, connection,  control, kNoLog, read_scene_delete},
    {"server.sessions",      admin,      connection,  query,   kNoLog, read_server_sessions},
    {"server.drain",         admin,      connection,  control, kNoLog, read_server_drain},
    {"server.move",          admin,      connection,  control, kNoLog, read_server_move},
  });
}();
// clang-format on

/// A session's method has a session handler, and only that has the role of a participant.
constexpr bool handlers_match_role_sources() {
  return std::ranges::all_of(kMethods, [](const Method& method) {
    const bool is_of_session = std::holds_alternative<SessionHandler>(method.handler);
    const bool can_be_logged = is_of_session || !method.row.is_logged();
    return is_of_session == (method.row.role_source == RoleSource::participant) && can_be_logged;
  });
}
static_assert(handlers_match_role_sources());

constexpr auto kNames = [] {
  std::array<std::string_view, kMethods.size()> names{};
  std::ranges::transform(kMethods, names.begin(),
                         [](const Method& method) { return method.row.name; });
  return names;
}();

const MethodRow* find_row(std::string_view name) {
  const Method* method = find_method(name);
  return method == nullptr ? nullptr : &method->row;
}

std::variant<SessionCommand, Errors> parse_command(std::string_view name, Json params) {
  const Method* method = find_method(name);
  const auto* handler = method == nullptr ? nullptr : std::get_if<SessionHandler>(&method->handler);
  if (handler == nullptr) {
    return Errors{{"method_not_found", "", "must be a method of a session"}};
  }
  Errors errors;
  ObjectReader reader(params, "", errors);
  SessionAction action = (*handler)(reader, errors);
  reader.refuse_unknown();
  if (!errors.empty()) return errors;
  VAT_CHECK(action != nullptr);
  return SessionCommand{&method->row, std::move(params), std::move(action)};
}

constexpr SessionMethods kSessionMethods{kNames, find_row, parse_command};

}  // namespace

std::span<const Method> all_methods() {
  return kMethods;
}

const Method* find_method(std::string_view name) {
  const auto found =
      std::ranges::find(kMethods, name, [](const Method& method) { return method.row.name; });
  return found == kMethods.end() ? nullptr : &*found;
}

const SessionMethods& session_methods() {
  return kSessionMethods;
}

}  // namespace vat
