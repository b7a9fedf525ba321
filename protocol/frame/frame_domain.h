#pragma once

#include <optional>

#include "core/scene/world.h"
#include "core/simulation/simulation.h"
#include "core/types.h"

namespace vat {

/// Box that the frame grids of an epoch cover. The box contains the vat in all positions of its
/// motion, and all particles of the last state. A margin prevents frequent changes of the grid,
/// which would make resting particles flicker. The box is at most four times as wide as its
/// content, so that one distant drop does not make all positions coarse.
class FrameDomain {
 public:
  FrameDomain() = default;
  explicit FrameDomain(const std::optional<Vat>& vat);
  void include(const PublishedState& state);
  FrameGrid grid(double max_error) const;
  /// Returns the grid with the box in its middle. Particles can therefore leave the box on all
  /// sides before they leave the grid.
  FrameGrid centered_grid(double max_error) const;

 private:
  using Box = Eigen::AlignedBox<Real, 3>;

  Box vat_;
  Box box_;
};

/// Returns the default position error of frames [m]: 1/64 of the particle spacing of the finest
/// liquid or deformable body. Without such a body, returns 0 (the finest grid).
double default_max_error(const Simulation& simulation);

}  // namespace vat
