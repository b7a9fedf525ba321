#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "core/simulation.h"
#include "server/session/rpc_message.h"
#include "server/session/session_environment.h"

namespace vat {

/// The method by which a session gets another scene; its first entry in a log is such a call.
inline constexpr std::string_view kLoadMethod = "scene.load";

/// Refuses every file: a scene or body from a client holds its meshes itself.
Result<std::string> refuse_mesh_file(const std::string& name);

/// A scene that a client named or wrote; errors point into the parameter `scene`.
std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue);

/// What a simulation has more of than one session may, if anything.
std::optional<RpcError> find_excess(const Simulation& simulation, const ServerLimits& limits);

/// A simulation within the limits; errors point into the parameter `scene`.
std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions);

}  // namespace vat
