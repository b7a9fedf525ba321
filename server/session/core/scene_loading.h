#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "core/simulation/simulation.h"
#include "server/messages/rpc_message.h"
#include "server/session/core/session_environment.h"
#include "server/support/resource_budget.h"

namespace vat {

/// Method that loads a scene. The first entry of a log has this name.
inline constexpr std::string_view kLoadMethod = "scene.load";
/// Method that loads a saved state.
inline constexpr std::string_view kLoadStateMethod = "session.load";

/// Refuses every file: scenes and bodies of clients contain their meshes.
Result<std::string> refuse_mesh_file(const std::string& name);

/// Reads a scene of the catalogue by its name, or a written scene. Errors point into the parameter
/// `scene`.
std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue);

/// Returns the saved scene with this name.
std::variant<Json, RpcError> find_saved_scene(const std::string& name,
                                              const SessionEnvironment& environment);
/// Reads a scene by its name in the catalogue or among the saved scenes, or a written scene. Errors
/// point into the parameter `scene`.
std::variant<Scene, RpcError> read_named_scene(const Json& value,
                                               const SessionEnvironment& environment);

/// Returns the error if the simulation exceeds a limit of one session.
std::optional<RpcError> find_excess(const Simulation& simulation, const ServerLimits& limits);

/// Returns the greatest size of a simulation's state within the limits.
std::size_t max_state_bytes(const ServerLimits& limits);

/// Returns the budget that a simulation needs, including particles that its emitters may add.
Resources resources_of(const Simulation& simulation);

/// Creates a simulation within the limits of one session. Errors point into the parameter `scene`.
std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions);

}  // namespace vat
