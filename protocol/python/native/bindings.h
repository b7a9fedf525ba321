#pragma once

#include <pybind11/pybind11.h>

#include "protocol/python/native/held_simulation.h"

namespace vat::python {

using SimulationClass = pybind11::class_<HeldSimulation>;

/// Scene files and the catalogue.
void bind_scenes(pybind11::module_& module);
/// The decoder of frames.
void bind_frames(pybind11::module_& module);
/// Writer and reader of recordings.
void bind_recordings(pybind11::module_& module);
/// Creation, time and snapshots.
void bind_simulation(SimulationClass& simulation);
/// Views of bodies.
void bind_bodies(SimulationClass& simulation);
/// Changes of a running scene.
void bind_commands(SimulationClass& simulation);
/// Diagnostics and fields.
void bind_measurements(SimulationClass& simulation);

}  // namespace vat::python
