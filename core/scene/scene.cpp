#include "core/scene/scene.h"

#include "core/support/check.h"

namespace vat {

const char* to_string(BodyKind kind) {
  switch (kind) {
    case BodyKind::liquid:
      return "liquid";
    case BodyKind::deformable:
      return "deformable";
    case BodyKind::rigid:
      return "rigid";
  }
  VAT_CHECK(false && "not a kind of body");
  return "";
}

const char* to_string(IntegratorId id) {
  switch (id) {
    case IntegratorId::explicit_euler:
      return "explicit_euler";
    case IntegratorId::symplectic_euler:
      return "symplectic_euler";
    case IntegratorId::velocity_verlet:
      return "velocity_verlet";
    case IntegratorId::heun:
      return "heun";
    case IntegratorId::runge_kutta_4:
      return "runge_kutta_4";
  }
  VAT_CHECK(false && "not an integrator");
  return "";
}

const char* to_string(StepControl control) {
  switch (control) {
    case StepControl::fixed:
      return "fixed";
    case StepControl::adaptive:
      return "adaptive";
    case StepControl::local:
      return "local";
  }
  VAT_CHECK(false && "not a step control");
  return "";
}

const char* to_string(PressureSolver solver) {
  switch (solver) {
    case PressureSolver::gas:
      return "gas";
    case PressureSolver::tait:
      return "tait";
    case PressureSolver::incompressible:
      return "incompressible";
  }
  VAT_CHECK(false && "not a pressure solver");
  return "";
}

const char* to_string(KernelId id) {
  switch (id) {
    case KernelId::wendland_c2:
      return "wendland_c2";
    case KernelId::cubic_spline:
      return "cubic_spline";
  }
  VAT_CHECK(false && "not a kernel");
  return "";
}

const char* to_string(PairPrecision precision) {
  switch (precision) {
    case PairPrecision::single_precision:
      return "single";
    case PairPrecision::double_precision:
      return "double";
  }
  VAT_CHECK(false && "not a precision");
  return "";
}

const char* to_string(SurfaceModel model) {
  switch (model) {
    case SurfaceModel::curvature:
      return "curvature";
    case SurfaceModel::cohesion:
      return "cohesion";
  }
  VAT_CHECK(false && "not a surface model");
  return "";
}

const char* to_string(InterfaceLaw law) {
  switch (law) {
    case InterfaceLaw::penalty:
      return "penalty";
    case InterfaceLaw::lennard_jones:
      return "lennard_jones";
    case InterfaceLaw::sph:
      return "sph";
    case InterfaceLaw::projection:
      return "projection";
  }
  VAT_CHECK(false && "not a law of an interface");
  return "";
}

}  // namespace vat
