#pragma once

#include <cstdint>

#include "core/device/common/step_moment.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// The struct Parameters of core/device/liquid/particles.cl, with the same members in the same
/// order. `Number` is the type of sums over pairs, and `Coordinate` that of integer positions.
template <class Number, class Coordinate>
struct LiquidParametersOf {
  double origin[3];     ///< of integer positions and of cells, moves with the vat [m]
  double inverse_unit;  ///< of integer positions [1/m]
  double wall_low[3];   ///< infinite without a wall [m]
  double wall_high[3];
  double wall_velocity[3];
  double period[3];      ///< length along periodic axes; 0 along others [m]
  double domain_low[3];  ///< bounds of valid positions [m]
  double domain_high[3];
  double greatest_speed2;  ///< bound of valid speeds, squared [m^2/s^2]
  double closing;          ///< duration of the kick at the end of a step; 0 without [s]
  double opening;          ///< duration of the kick at the start of a step [s]
  double drift;            ///< [s]
  double prediction;       ///< duration of the kick of velocities in viscous forces [s]
  double field_center[3];  ///< of the central field [m]
  double field_strength;   ///< acceleration / distance from the center; 0 without a field [1/s^2]
  Number gravity[3];
  Number still[3];      ///< velocity that the settling drag leaves [m/s]
  Number drag;          ///< of settling [1/s]
  Number fall[3];       ///< free fall in the frame of the vat [m/s^2]
  Number unit;          ///< [m]
  Number in_supports;   ///< unit / support radius
  Number density;       ///< at rest [kg/m^3]
  Number layer;         ///< pressure under one layer of particles [Pa]
  Number stiffness;     ///< density times square of the speed of sound [Pa]
  Number tension;       ///< maximum tension [Pa]
  Number slope_factor;  ///< acceleration / sum of pressures and gradients
  Number viscosity;     ///< central viscosity / support radius
  Number solid_factor;  ///< force on a solid / (its weight times sum of pressures and gradients)
  Number speeds_of_walls[18];  ///< velocity of the surface of each wall [m/s]
  Coordinate twice_low[3];     ///< 2 wall_low in integer positions
  Coordinate twice_high[3];
  Coordinate periods[3];  ///< period in integer positions; 0 along other axes
  std::int32_t cells[3];
  std::int32_t cell_bits;    ///< a cell has 2^cell_bits integer positions along each axis
  std::int32_t reach;        ///< cells that a support radius extends into beside the own one
  Coordinate support;        ///< support radius in integer positions
  std::int32_t walls;        ///< bit w: wall w exists
  std::int32_t sides;        ///< bit w: wall w exists, or its axis is periodic
  std::int32_t no_slip;      ///< bit w: liquid does not slip along wall w
  std::int32_t is_thick;     ///< 1: slip walls are viscous, see is_thick()
  std::int32_t bounces;      ///< 1: walls reverse velocities; 0: walls remove them
  std::int32_t is_filled;    ///< see Model::is_filled
  std::int32_t count;        ///< liquid particles
  std::int32_t solids;       ///< solid particles
  std::int32_t list_length;  ///< greatest number of neighbours in a list
};

/// The parameters on the host, which are those of sums in double precision.
struct LiquidParameters : LiquidParametersOf<double, std::int64_t> {
  /// Returns the parameters of sums in single precision. The integer positions must fit.
  LiquidParametersOf<float, std::int32_t> in_single_precision() const;
};

/// Returns the bits of the sides across periodic axes.
std::int32_t periodic_sides(const Model& model);

/// Sets the walls of the parameters so far away that they stop no particles. Images in the walls
/// remain.
void remove_walls(LiquidParameters& parameters);

/// Computes the parameters of kernels for a model with one liquid.
class LiquidGeometry {
 public:
  LiquidGeometry(const Model& model, const GuardBounds& bounds);

  LiquidParameters at(const Model& model, const StepMoment& moment) const;
  std::size_t cell_count() const;
  /// Returns the greatest number of neighbours in a list.
  std::size_t list_length() const { return static_cast<std::size_t>(constant_.list_length); }
  /// Returns the square of the greatest valid speed in a step of `dt` [s], see GuardBounds::travel.
  Real greatest_speed2(Real dt) const;

 private:
  void set_grid(const Model& model);
  void set_period(const Model& model);

  LiquidParameters constant_{};
  Real travel_ = 0;             ///< [m]
  Vec3 origin_ = Vec3::Zero();  ///< without the displacement of the vat [m]
};

}  // namespace vat
