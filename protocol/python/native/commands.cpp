// Commands that change a running scene.

#include <pybind11/stl.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "core/support/nearest_name.h"
#include "protocol/python/native/bindings.h"
#include "protocol/scene/scene_json.h"

namespace py = pybind11;

namespace vat::python {
namespace {

using Turn = HeldSimulation::Turn;

/// Adds a method that is a command of HostInterface. `command` receives the simulation.
template <class... Arguments>
void bind_command(SimulationClass& simulation, const char* name,
                  Status (*command)(Simulation&, Arguments...)) {
  simulation.def(name, [command](HeldSimulation& held, Arguments... arguments) {
    Turn turn(held);
    require(command(turn.change(), std::move(arguments)...));
  });
}

Json parse(const std::string& text) {
  return value_of(parse_json(text, kSceneLimits));
}

BodyId add_body(HeldSimulation& held, const std::string& text, const std::string& folder) {
  const BodyDescription body = value_of(read_body(parse(text), "/body", meshes_in_folder(folder)));
  Turn turn(held);
  return value_of(turn.change().add_body(body));
}

Status move_body(Simulation& simulation, BodyId id, py::object center, py::object orientation,
                 py::object velocity) {
  BodyPlacement placement{to_vector(center, "center_of_mass")};
  if (!orientation.is_none()) placement.orientation = to_orientation(orientation, "orientation");
  if (!velocity.is_none()) placement.velocity = to_vector(velocity, "velocity");
  return simulation.move_body(id, placement);
}

Status set_numerics(Simulation& simulation, std::string name, Real step) {
  const auto found = std::ranges::find(kNamesOf<IntegratorId>, std::string_view(name));
  if (found == kNamesOf<IntegratorId>.end()) {
    std::string rule = "must be one of";
    for (const char* known : kNamesOf<IntegratorId>) rule += std::string(" ") + known;
    return unknown_name({}, "/integrator", rule, name, kNamesOf<IntegratorId>, std::identity());
  }
  return simulation.set_numerics(static_cast<IntegratorId>(found - kNamesOf<IntegratorId>.begin()),
                                 step);
}

/// Starts a grab with an unused number above `after`. Returns the number.
std::uint64_t grab_start(HeldSimulation& held, std::uint64_t after, BodyId id, Index particle,
                         const py::object& target) {
  Turn turn(held);
  std::uint64_t grab = after + 1;
  while (turn->grab_target(grab)) ++grab;
  require(turn.change().grab_start(grab, id, particle, to_vector(target, "target")));
  return grab;
}

}  // namespace

void bind_commands(SimulationClass& simulation) {
  simulation.def("add_body", &add_body);
  bind_command(
      simulation, "remove_body", +[](Simulation& host, BodyId id) { return host.remove_body(id); });
  bind_command(simulation, "move_body", &move_body);
  bind_command(
      simulation, "set_material", +[](Simulation& host, std::string text) {
        return host.set_material(value_of(read_material(parse(text), "/material")));
      });
  bind_command(
      simulation, "set_interface", +[](Simulation& host, std::string text) {
        return host.set_interface(value_of(read_interface(parse(text), "/interface")));
      });
  bind_command(
      simulation, "move_vat", +[](Simulation& host, py::object offset) {
        return host.move_vat(to_vector(offset, "offset"));
      });
  bind_command(
      simulation, "set_emitter",
      +[](Simulation& host, std::string name, bool open) { return host.set_emitter(name, open); });
  bind_command(
      simulation, "melt_body", +[](Simulation& host, BodyId id, std::string material) {
        return host.melt_body(id, material);
      });
  bind_command(
      simulation, "set_gravity", +[](Simulation& host, py::object gravity) {
        return host.set_gravity(to_vector(gravity, "gravity"));
      });
  bind_command(simulation, "set_numerics", &set_numerics);
  bind_command(
      simulation, "apply_force", +[](Simulation& host, BodyId id, py::object force, Real duration) {
        return host.apply_force(id, to_vector(force, "force"), duration);
      });
  simulation.def("grab_start", &grab_start);
  bind_command(
      simulation, "grab_move", +[](Simulation& host, std::uint64_t grab, py::object target) {
        return host.grab_move(grab, to_vector(target, "target"));
      });
  bind_command(
      simulation, "grab_end",
      +[](Simulation& host, std::uint64_t grab) { return host.grab_end(grab); });
}

}  // namespace vat::python
