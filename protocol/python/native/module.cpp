// The native part of the Python package vat. vat/_native.pyi lists its functions; the modules of
// vat document them.

#include "protocol/python/native/bindings.h"

PYBIND11_MODULE(_native, module) {
  vat::python::bind_scenes(module);
  vat::python::bind_frames(module);
  vat::python::bind_recordings(module);
  vat::python::SimulationClass simulation(module, "Simulation");
  vat::python::bind_simulation(simulation);
  vat::python::bind_bodies(simulation);
  vat::python::bind_commands(simulation);
  vat::python::bind_measurements(simulation);
}
