// Diagnostics and fields of a simulation.

#include <pybind11/stl.h>

#include "protocol/python/native/bindings.h"

namespace py = pybind11;

namespace vat::python {
namespace {

using Turn = HeldSimulation::Turn;

py::object optional_tuple(const auto& value) {
  return value ? py::object(to_tuple(*value)) : py::none();
}

py::dict to_dict(const BodyDiagnostics& body) {
  py::dict dict;
  dict["id"] = body.id;
  dict["name"] = body.name;
  dict["mass"] = body.mass;
  dict["center_of_mass"] = to_tuple(body.center_of_mass);
  dict["linear_momentum"] = to_tuple(body.linear_momentum);
  dict["angular_momentum"] = to_tuple(body.angular_momentum);
  dict["outer_force"] = to_tuple(body.outer_force);
  dict["outer_torque"] = to_tuple(body.outer_torque);
  dict["orientation"] = optional_tuple(body.orientation);
  dict["angular_velocity"] = optional_tuple(body.angular_velocity);
  return dict;
}

py::dict to_dict(const Diagnostics& all) {
  py::dict dict;
  dict["time"] = all.time;
  py::list bodies;
  for (const BodyDiagnostics& body : all.bodies) bodies.append(to_dict(body));
  dict["bodies"] = bodies;
  dict["kinetic_energy"] = all.kinetic_energy;
  dict["gravitational_energy"] = all.gravitational_energy;
  dict["elastic_energy"] = all.elastic_energy;
  dict["contact_energy"] = all.contact_energy;
  dict["mean_density_error"] = all.mean_density_error;
  dict["max_density_error"] = all.max_density_error;
  dict["axle_torque"] = all.axle_torque;
  dict["torn_springs"] = all.torn_springs;
  dict["particles_outside"] = all.particles_outside;
  dict["sleeping_bodies"] = all.sleeping_bodies;
  dict["emitted_particles"] = all.emitted_particles;
  dict["drained_particles"] = all.drained_particles;
  return dict;
}

template <class Measure>
auto measure(HeldSimulation& held, Measure measure) {
  const Turn turn(held);
  const py::gil_scoped_release released;
  return measure(turn);
}

}  // namespace

void bind_measurements(SimulationClass& simulation) {
  simulation.def("diagnostics", [](HeldSimulation& held) {
    return to_dict(measure(held, [](const Turn& turn) { return turn->diagnostics(); }));
  });
  simulation.def("liquid_fields", [](HeldSimulation& held, BodyId id) {
    LiquidFields fields =
        value_of(measure(held, [id](const Turn& turn) { return turn->liquid_fields(id); }));
    return py::make_tuple(own_array(std::move(fields.density)),
                          own_array(std::move(fields.pressure)));
  });
}

}  // namespace vat::python
