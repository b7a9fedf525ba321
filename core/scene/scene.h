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

/// A scene as plain values in SI units, as in a scene file. The values are not checked.
/// core/validation/validate.h defines their ranges, and core/model/compile.h compiles the scene.
namespace vat {

/// All initial data of a simulation.
struct Scene {
  std::string name;
  std::string title;
  std::string description;
  Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
  std::vector<Material> materials;
  std::vector<InterfaceDescription> interfaces;
  InterfaceConstants default_interface{1000, 1};  ///< for pairs that are not in `interfaces`
  std::vector<BodyDescription> bodies;
  std::optional<Vat> vat;
  std::optional<Periodicity> periodic;
  std::optional<CentralField> central_field;
  std::optional<Settling> settling;
  std::optional<Sleeping> sleeping;  ///< if absent, bodies never sleep
  std::vector<Emitter> emitters;
  std::vector<Drain> drains;
  ForceSwitches forces;
  PressureSolver pressure_solver = PressureSolver::tait;
  IncompressibleSolve incompressible;  ///< only for the incompressible solver
  /// For the solver gas: whether the pressure force is halved, as in Boldt and [MCG03], for
  /// comparison.
  bool printed_pressure_force = false;
  KernelId kernel = KernelId::wendland_c2;  ///< kernel of liquids; gas uses those of [MCG03]
  /// Precision of the sums over pairs of liquid particles. The solver gas uses double precision.
  PairPrecision pair_precision = PairPrecision::single_precision;
  SurfaceModel surface_model = SurfaceModel::curvature;
  /// Number of dimensions, 3 or 2. In two dimensions, all motion is in the plane y = 0, with
  /// two-dimensional kernels and sampled masses. Masses, forces and energies are then per metre of
  /// depth.
  int dimensions = 3;
  Numerics numerics;
};

}  // namespace vat
