#pragma once

#include <functional>
#include <optional>

#include "protocol/json/json_reader.h"
#include "server/clients/pending_reply.h"
#include "server/directory/session_directory.h"
#include "server/session/core/session_command.h"

/// Handlers of all methods. A handler reads the parameters and returns the action that executes the
/// call. A handler adds an error to `errors` for each invalid parameter. The caller then ignores
/// the action.
namespace vat {

/// Action of a server method, called on the transport's thread. Returns the reply, or nothing if
/// the reply was moved for a later answer.
using ServerAction = std::function<std::optional<RpcResult>(SessionDirectory&, PendingReply&)>;

using ServerHandler = ServerAction (*)(ObjectReader& params, Errors& errors);
using SessionHandler = SessionAction (*)(ObjectReader& params, Errors& errors);

// server.cpp
ServerAction read_server_info(ObjectReader& params, Errors& errors);
ServerAction read_scene_list(ObjectReader& params, Errors& errors);
ServerAction read_scene_levels(ObjectReader& params, Errors& errors);

// scene.cpp
SessionAction read_scene_get(ObjectReader& params, Errors& errors);

// session.cpp
ServerAction read_session_create(ObjectReader& params, Errors& errors);
ServerAction read_session_list(ObjectReader& params, Errors& errors);
ServerAction read_session_join(ObjectReader& params, Errors& errors);
ServerAction read_session_leave(ObjectReader& params, Errors& errors);
ServerAction read_session_close(ObjectReader& params, Errors& errors);

// control.cpp
SessionAction read_scene_load(ObjectReader& params, Errors& errors);
SessionAction read_control_play(ObjectReader& params, Errors& errors);
SessionAction read_control_pause(ObjectReader& params, Errors& errors);
SessionAction read_control_step(ObjectReader& params, Errors& errors);
SessionAction read_control_reset(ObjectReader& params, Errors& errors);
SessionAction read_control_set_speed(ObjectReader& params, Errors& errors);

// world.cpp
SessionAction read_world_add_body(ObjectReader& params, Errors& errors);
SessionAction read_world_remove_body(ObjectReader& params, Errors& errors);
SessionAction read_world_melt_body(ObjectReader& params, Errors& errors);
SessionAction read_world_set_emitter(ObjectReader& params, Errors& errors);
SessionAction read_world_set_gravity(ObjectReader& params, Errors& errors);
SessionAction read_world_set_interface(ObjectReader& params, Errors& errors);
SessionAction read_world_apply_force(ObjectReader& params, Errors& errors);

// edit.cpp
SessionAction read_world_move_body(ObjectReader& params, Errors& errors);
SessionAction read_world_set_material(ObjectReader& params, Errors& errors);
SessionAction read_world_set_numerics(ObjectReader& params, Errors& errors);
SessionAction read_world_move_vat(ObjectReader& params, Errors& errors);

// grab.cpp
SessionAction read_grab_start(ObjectReader& params, Errors& errors);
SessionAction read_grab_move(ObjectReader& params, Errors& errors);
SessionAction read_grab_end(ObjectReader& params, Errors& errors);

// frames.cpp
SessionAction read_frames_subscribe(ObjectReader& params, Errors& errors);
SessionAction read_frames_unsubscribe(ObjectReader& params, Errors& errors);
ServerAction read_frames_ack(ObjectReader& params, Errors& errors);

// state.cpp
SessionAction read_state_query(ObjectReader& params, Errors& errors);
SessionAction read_state_connections(ObjectReader& params, Errors& errors);
SessionAction read_session_hash(ObjectReader& params, Errors& errors);
SessionAction read_session_stats(ObjectReader& params, Errors& errors);
SessionAction read_recording_export(ObjectReader& params, Errors& errors);

// people.cpp
SessionAction read_session_configure(ObjectReader& params, Errors& errors);
SessionAction read_session_invite(ObjectReader& params, Errors& errors);
SessionAction read_participant_rename(ObjectReader& params, Errors& errors);
SessionAction read_participant_set_role(ObjectReader& params, Errors& errors);
SessionAction read_participant_kick(ObjectReader& params, Errors& errors);
SessionAction read_control_request(ObjectReader& params, Errors& errors);
SessionAction read_control_hand_over(ObjectReader& params, Errors& errors);

// presence.cpp
SessionAction read_presence_list(ObjectReader& params, Errors& errors);
SessionAction read_presence_point(ObjectReader& params, Errors& errors);

// access.cpp
ServerAction read_access_enter(ObjectReader& params, Errors& errors);
ServerAction read_access_ticket(ObjectReader& params, Errors& errors);

// replay.cpp
ServerAction read_recording_import(ObjectReader& params, Errors& errors);
ServerAction read_replay_open(ObjectReader& params, Errors& errors);
SessionAction read_replay_info(ObjectReader& params, Errors& errors);
SessionAction read_replay_seek(ObjectReader& params, Errors& errors);

// saved.cpp
SessionAction read_session_save(ObjectReader& params, Errors& errors);
SessionAction read_session_load(ObjectReader& params, Errors& errors);
SessionAction read_session_saves(ObjectReader& params, Errors& errors);
SessionAction read_session_delete_save(ObjectReader& params, Errors& errors);
SessionAction read_scene_save(ObjectReader& params, Errors& errors);
ServerAction read_scene_delete(ObjectReader& params, Errors& errors);

// admin.cpp
ServerAction read_server_sessions(ObjectReader& params, Errors& errors);
ServerAction read_server_drain(ObjectReader& params, Errors& errors);
ServerAction read_server_move(ObjectReader& params, Errors& errors);

}  // namespace vat
