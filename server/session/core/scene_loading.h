#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "core/simulation/simulation.h"
#include "protocol/scene/level.h"
#include "server/messages/rpc_message.h"
#include "server/session/core/session_environment.h"
#include "server/support/resource_budget.h"

namespace vat {

/// Name of the method that loads a scene. The first entry of a log has this method.
inline constexpr std::string_view kLoadMethod = "scene.load";
/// Name of the method that loads a saved state.
inline constexpr std::string_view kLoadStateMethod = "session.load";

/// Returns an error for every file, because scenes and bodies from clients contain their meshes.
Result<std::string> refuse_mesh_file(const std::string& name);

/// Returns an error no_such_scene, with a suggestion from the catalogue.
RpcError unknown_scene(std::string_view name, const Catalogue& catalogue);

/// Returns a scene, given by its catalogue name or as JSON, at a level of detail. Paths of errors
/// begin with the parameter `scene`.
std::variant<Scene, RpcError> read_client_scene(const Json& value, const Catalogue& catalogue,
                                                Level level = Level::normal);

/// Returns the saved scene with this name, or an error.
std::variant<Json, RpcError> find_saved_scene(const std::string& name,
                                              const SessionEnvironment& environment);
/// Returns a scene at a level of detail, given by JSON or by its name in the catalogue or among the
/// saved scenes. Paths of errors begin with the parameter `scene`.
std::variant<Scene, RpcError> read_named_scene(const Json& value, Level level,
                                               const SessionEnvironment& environment);
/// Returns the optional parameter `level` of a method that loads a scene.
Level read_level(ObjectReader& params);

/// Returns an error if the simulation exceeds a limit of one session.
std::optional<RpcError> find_excess(const Simulation& simulation, const ServerLimits& limits);

/// Returns the greatest size [bytes] of a simulation's state within the limits.
std::size_t max_state_bytes(const ServerLimits& limits);

/// Returns the resources that a simulation needs, including particles that its emitters may add.
Resources resources_of(const Simulation& simulation);

/// Returns a simulation within the limits of one session, or an error. Paths of errors begin with
/// the parameter `scene`.
std::variant<Simulation, RpcError> make_simulation(const Scene& scene,
                                                   const SessionEnvironment& environment,
                                                   InstructionSet instructions);

/// Returns the scene with the device on which a session computes it. The server's device replaces
/// the device that the scene names. An automatic choice measures steps, which takes long. The
/// result has no device for the CPU. Paths of errors begin with the parameter `scene`.
std::variant<Scene, RpcError> with_device(Scene scene, const SessionEnvironment& environment);
/// Returns the parameters of scene.load with the result of with_device(). The parameter `scene`
/// must be a scene.
std::variant<Json, RpcError> with_device(Json params, const SessionEnvironment& environment);
/// Returns the device of a scene with the result of with_device(), or the CPU if the server uses no
/// devices.
DeviceChoice device_of(const Scene& scene, const SessionEnvironment& environment);
/// Returns the result of make_simulation(), whose steps are computed on the device of the scene.
std::variant<Simulation, RpcError> make_on_device(const Scene& scene,
                                                  const SessionEnvironment& environment,
                                                  InstructionSet instructions);

}  // namespace vat
