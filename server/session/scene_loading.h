#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "core/simulation/simulation.h"
#include "server/admission/resource_budget.h"
#include "server/session/rpc_message.h"
#include "server/session/session_environment.h"

namespace vat {

/// The method by which a session gets another scene; its first entry in a log is such a call.
inline constexpr std::string_view kLoadMethod = "scene.load";
/// The method by which it gets a state that was saved.
inline constexpr std::string_view kLoadStateMethod = "session.load";

/// Refuses every file: a scene or body from a client holds its meshes itself.
Result<std::string> refuse_mesh_file(const std::string& name);

/// A scene of the catalogue by its name, or one that is written; errors point into the parameter
/// `scene`.
std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue);

/// The scene that a user has saved under this name, written out.
std::variant<Json, RpcError> find_saved_scene(const std::string& name,
                                              const SessionEnvironment& environment);
/// A scene that is named, by the catalogue or a user, or written; errors point into the parameter
/// `scene`.
std::variant<Scene, RpcError> read_named_scene(const Json& value,
                                               const SessionEnvironment& environment);

/// What a simulation has more of than one session may, if anything.
std::optional<RpcError> find_excess(const Simulation& simulation, const ServerLimits& limits);

/// The most bytes of a simulation's state that are unpacked, where the limits are these.
std::size_t most_state_bytes(const ServerLimits& limits);

/// What it takes of the budget of all sessions; what its emitters may add included.
Resources resources_of(const Simulation& simulation);
/// The error that tells of the excess.
RpcError limit_reached(const ResourceExcess& excess);

/// A simulation within the limits of one session; errors point into the parameter `scene`.
std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions);

}  // namespace vat
