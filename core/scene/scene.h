#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/body.h"
#include "core/scene/interface.h"
#include "core/scene/liquid_model.h"
#include "core/scene/material.h"
#include "core/scene/numerics.h"
#include "core/scene/world.h"
#include "core/types.h"

/// A scene as plain values, as a user writes it, in SI units. The values are not checked; see
/// core/validation/validate.h for their ranges and core/model/compile.h for the compiled scene.
namespace vat {

/// All that a simulation starts from.
struct Scene {
  std::string name;
  std::string title;
  std::string description;
  Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
  std::vector<Material> materials;
  std::vector<InterfaceDescription> interfaces;
  InterfaceConstants default_interface{1000, 1};  ///< for pairs that `interfaces` does not list
  std::vector<BodyDescription> bodies;
  std::optional<Vat> vat;
  std::optional<Periodicity> periodic;
  std::optional<CentralField> central_field;
  std::optional<Settling> settling;
  std::optional<Sleeping> sleeping;  ///< nothing ever sleeps without
  std::vector<Emitter> emitters;
  std::vector<Drain> drains;
  ForceSwitches forces;
  PressureSolver pressure_solver = PressureSolver::tait;
  IncompressibleSolve incompressible;  ///< used by that solver
  /// For the solver gas: half of the pressure force, as in Boldt and [MCG03], for comparison.
  bool printed_pressure_force = false;
  KernelId kernel = KernelId::wendland_c2;  ///< of liquids; gas uses those of [MCG03]
  /// Precision of the sums over pairs of liquids; the solver gas uses double precision.
  PairPrecision pair_precision = PairPrecision::single_precision;
  SurfaceModel surface_model = SurfaceModel::curvature;
  /// 3, or 2: everything stays in the plane y = 0, kernels and sampled masses are those of two
  /// dimensions, and masses, forces and energies are per metre of depth.
  int dimensions = 3;
  Numerics numerics;
};

}  // namespace vat
