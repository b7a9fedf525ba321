// Views of the bodies of a simulation.

#include <string>

#include "protocol/python/native/bindings.h"

namespace py = pybind11;

namespace vat::python {
namespace {

using Turn = HeldSimulation::Turn;

BodyView view_of(const Turn& turn, BodyId id) {
  const std::optional<BodyView> body = turn->find_body(id);
  if (!body) throw py::key_error("the body with the id " + std::to_string(id) + " was removed");
  return *body;
}

/// Adds a property that is a function of a body's view.
template <class Get>
void bind_view(SimulationClass& simulation, const char* name, Get get) {
  simulation.def(name, [get](HeldSimulation& held, BodyId id) {
    const Turn turn(held);
    return get(turn, view_of(turn, id));
  });
}

py::object pose_of(const BodyView& body) {
  if (!body.pose) return py::none();
  py::dict dict;
  dict["center_of_mass"] = to_tuple(body.pose->center_of_mass);
  dict["orientation"] = to_tuple(body.pose->orientation);
  dict["velocity"] = to_tuple(body.pose->velocity);
  dict["angular_velocity"] = to_tuple(body.pose->angular_velocity);
  return dict;
}

std::vector<Index> numbers_of(const BodyView& body) {
  std::vector<Index> numbers(body.numbers.begin(), body.numbers.end());
  for (std::size_t i = numbers.size(); i < body.positions.size(); ++i) {
    numbers.push_back(static_cast<Index>(i));
  }
  return numbers;
}

}  // namespace

void bind_bodies(SimulationClass& simulation) {
  simulation.def("body_ids", [](HeldSimulation& held) {
    py::list ids;
    for (const BodyView& body : Turn(held)->bodies()) ids.append(body.id);
    return ids;
  });
  simulation.def("find_body", [](HeldSimulation& held, const std::string& name) {
    return Turn(held)->find_body(name);
  });
  simulation.def("has_body", [](HeldSimulation& held, BodyId id) {
    return Turn(held)->find_body(id).has_value();
  });
  bind_view(simulation, "body_name",
            [](const Turn&, const BodyView& body) { return std::string(body.name); });
  bind_view(simulation, "body_kind",
            [](const Turn&, const BodyView& body) { return std::string(to_string(body.kind)); });
  bind_view(simulation, "body_material",
            [](const Turn&, const BodyView& body) { return std::string(body.material); });
  bind_view(simulation, "body_pose",
            [](const Turn&, const BodyView& body) { return pose_of(body); });
  bind_view(simulation, "body_is_asleep",
            [](const Turn&, const BodyView& body) { return body.is_asleep; });
  bind_view(simulation, "body_numbers",
            [](const Turn&, const BodyView& body) { return own_array(numbers_of(body)); });
  bind_view(simulation, "body_positions", [](const Turn& turn, const BodyView& body) {
    return turn.view(reinterpret_cast<const Real*>(body.positions.data()), body.positions.size(),
                     true);
  });
  bind_view(simulation, "body_velocities", [](const Turn& turn, const BodyView& body) {
    return turn.view(reinterpret_cast<const Real*>(body.velocities.data()), body.velocities.size(),
                     true);
  });
  bind_view(simulation, "body_masses", [](const Turn& turn, const BodyView& body) {
    return turn.view(body.masses.data(), body.masses.size(), false);
  });
  bind_view(simulation, "body_radii", [](const Turn& turn, const BodyView& body) {
    return turn.view(body.radii.data(), body.radii.size(), false);
  });
}

}  // namespace vat::python
