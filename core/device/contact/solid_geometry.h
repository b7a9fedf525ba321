#pragma once

#include <array>
#include <cstdint>

#include "core/device/common/step_moment.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// The struct Solids of core/device/solid/particles.cl, with the same members in the same order.
struct SolidParameters {
  double origin[3];        ///< of the cells, and of a periodic box [m]
  double period[3];        ///< length along periodic axes; 0 along others [m]
  double inverse_cell;     ///< [1/m]
  double gravity[3];       ///< [m/s^2]
  double field_center[3];  ///< of the central field [m]
  double field_strength;   ///< acceleration / distance from the center; 0 without a field [1/s^2]
  double offset[3];        ///< displacement of the vat [m]
  double wall_low[3];      ///< without the displacement [m]
  double wall_high[3];
  double plane_low[3];  ///< first coordinate inside, with the displacement [m]
  double plane_high[3];
  double wall_velocity[3];
  double speeds_of_walls[18];  ///< velocity of the surface of each wall relative to the vat [m/s]
  double domain_low[3];        ///< bounds of valid positions [m]
  double domain_high[3];
  double closing;     ///< duration of the kick at the end of a step; 0 without [s]
  double opening;     ///< duration of the kick at the start of a step [s]
  double drift;       ///< [s]
  double prediction;  ///< duration of the kick of velocities in forces [s]
  double prediction_of_liquids;
  double reach;      ///< Model::contact_reach; 0: no contacts [m]
  double step;       ///< duration of a step for the guard [s]
  double max_speed;  ///< kMaxSpeed
  std::int32_t cells[3];
  std::int32_t walls;       ///< bit w: wall w exists
  std::int32_t walls_push;  ///< 1: walls exert forces
  std::int32_t free;        ///< free particles
  std::int32_t count;       ///< all particles
  std::int32_t materials;
  std::int32_t dimensions;
  std::int32_t first;     ///< index of the first of these particles in the model
  std::int32_t liquids;   ///< particles of gas-like liquids
  std::int32_t implicit;  ///< first particle with implicit springs; `free` without
  std::int32_t padding;
};

/// The particles of a model with contacts, which are its last particles: those of solids and of
/// gas-like liquids. Their kernels count from the first of them. Free particles precede those of
/// rigid bodies, and liquids precede deformable bodies.
struct SolidRange {
  explicit SolidRange(const Model& model)
      : first(model.is_coupled ? model.liquid_count : 0),
        liquids(model.liquid_count - first),
        free(model.free_count - first),
        count(model.particle_count - first) {}

  std::size_t first;    ///< index of the first of these particles in the model
  std::size_t liquids;  ///< particles of gas-like liquids
  std::size_t free;
  std::size_t count;
};

/// Returns whether any solid can move. Fixed bodies move with their initial velocities. In a
/// liquid, solids at rest need less memory and work.
bool solids_move(const Model& model);

/// Computes the parameters of kernels for the particles of SolidRange.
class SolidGeometry {
 public:
  SolidGeometry(const Model& model, const GuardBounds& bounds);

  SolidParameters at(const Model& model, const StepMoment& moment) const;
  std::size_t cell_count() const;

 private:
  void set_grid(const Model& model);

  SolidParameters constant_{};
};

}  // namespace vat
