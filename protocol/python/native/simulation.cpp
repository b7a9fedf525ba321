// Creation, time and snapshots of a simulation.

#include <algorithm>
#include <string>
#include <string_view>

#include "protocol/python/native/bindings.h"
#include "protocol/scene/scene_json.h"

namespace py = pybind11;

namespace vat::python {
namespace {

using Turn = HeldSimulation::Turn;

std::unique_ptr<HeldSimulation> create(const std::string& text, const std::string& folder,
                                       std::size_t threads, const std::string& instructions) {
  const Scene scene = value_of(read_scene_text(text, meshes_in_folder(folder)));
  return std::make_unique<HeldSimulation>(scene, threads, instructions);
}

py::dict event_dict(const GuardEvent& event) {
  py::dict dict;
  dict["cause"] = to_string(event.cause);
  dict["time"] = event.time;
  dict["body"] = event.body;
  dict["particle"] = event.particle;
  dict["step"] = event.step;
  dict["recovered"] = event.recovered;
  return dict;
}

/// Sums of the reports of successive calls.
struct Totals {
  AdvanceReport report;

  void add(const AdvanceReport& part) {
    report.steps += part.steps;
    report.undone_steps += part.undone_steps;
    report.wall_stops += part.wall_stops;
    report.unsolved_drifts += part.unsolved_drifts;
    report.force_evaluations += part.force_evaluations;
    report.particle_evaluations += part.particle_evaluations;
    for (const GuardEvent& event : part.events) report.add(event);
    report.failed = part.failed;
  }

  py::dict to_dict() const {
    py::dict dict;
    dict["steps"] = report.steps;
    dict["undone_steps"] = report.undone_steps;
    dict["wall_stops"] = report.wall_stops;
    dict["unsolved_drifts"] = report.unsolved_drifts;
    dict["force_evaluations"] = report.force_evaluations;
    dict["particle_evaluations"] = report.particle_evaluations;
    py::list events;
    for (const GuardEvent& event : report.events) events.append(event_dict(event));
    dict["events"] = events;
    dict["failed"] = report.failed;
    return dict;
  }
};

/// Takes steps tick by tick. A signal, such as Ctrl-C, ends the call between two ticks.
py::dict step(HeldSimulation& held, std::uint64_t steps) {
  Turn turn(held);
  Simulation& simulation = turn.change();
  Totals totals;
  for (std::uint64_t left = steps; left > 0 && !totals.report.failed;) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(left, simulation.steps_per_tick()));
    {
      const py::gil_scoped_release released;
      totals.add(simulation.advance(count));
    }
    left -= count;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return totals.to_dict();
}

}  // namespace

void bind_simulation(SimulationClass& simulation) {
  simulation.def(py::init(&create));
  simulation.def_static("load", [](const py::bytes& bytes, std::size_t threads) {
    return std::make_unique<HeldSimulation>(bytes_of(bytes), threads);
  });
  simulation.def("step", &step);
  simulation.def_property_readonly("time", [](HeldSimulation& held) { return Turn(held)->time(); });
  simulation.def_property_readonly("step_size",
                                   [](HeldSimulation& held) { return Turn(held)->step_size(); });
  simulation.def_property_readonly(
      "steps_per_tick", [](HeldSimulation& held) { return Turn(held)->steps_per_tick(); });
  simulation.def_property_readonly(
      "particle_count", [](HeldSimulation& held) { return Turn(held)->particle_count(); });
  simulation.def_property_readonly(
      "arithmetic", [](HeldSimulation& held) { return std::string(Turn(held)->arithmetic()); });
  simulation.def_property_readonly("state_hash",
                                   [](HeldSimulation& held) { return Turn(held)->state_hash(); });
  simulation.def_property_readonly(
      "scene", [](HeldSimulation& held) { return write_scene(Turn(held)->scene()).dump(); });
  simulation.def("snapshot", [](HeldSimulation& held) {
    const std::vector<std::uint8_t> bytes = Turn(held)->snapshot().to_bytes();
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  simulation.def("restore", [](HeldSimulation& held, const py::bytes& bytes) {
    Turn turn(held);
    const Simulation saved =
        value_of(Simulation::load(bytes_of(bytes), nullptr, turn->instruction_set()));
    turn.change().restore(saved.snapshot());
  });
}

}  // namespace vat::python
