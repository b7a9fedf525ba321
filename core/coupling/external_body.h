#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/simulation/body_values.h"
#include "core/types.h"

namespace vat {

/// Time interval of a step of the scene.
struct CouplingInterval {
  Real start = 0;  ///< [s]
  Real end = 0;    ///< [s]
  Real length() const { return end - start; }
};

/// Impulses that the scene exerted on an external body in one step: contacts, liquids, walls and
/// commands of users. The gravity of the scene is not included.
struct ReceivedImpulses {
  Vec3 linear = Vec3::Zero();  ///< on the whole body [N s]
  /// On rigid bodies: integral of the torque about the centre of mass, world axes [N m s].
  Vec3 angular = Vec3::Zero();
  std::span<const Vec3> particles{};  ///< on each particle of a deformable body [N s]
};

/// External simulator of one body, with its own forces and steps. CoupledSimulation describes the
/// coupling.
class ExternalBody {
 public:
  virtual ~ExternalBody() = default;

  /// Writes the motion at the time `time` [s] to `motion`. `body` is the body of the scene at this
  /// time, whose motion is in `motion` before the call. Called once by CoupledSimulation::attach().
  virtual void start(Real time, const BodyView& body, BodyMotion& motion) = 0;

  /// Moves from the start to the end of the interval, with any number of steps. The impulses acted
  /// in this interval. The coupling has order 2 in the step of the scene if half of the impulses is
  /// applied at the start and half at the end. Before the call, `motion` contains the motion at the
  /// end of the step of the scene. The function replaces it by the external motion.
  virtual void advance(const CouplingInterval& interval, const ReceivedImpulses& impulses,
                       BodyMotion& motion) = 0;

  /// Returns all data that determine the next calls of advance(), or nothing if the body cannot be
  /// saved.
  virtual std::optional<std::vector<std::uint8_t>> save() const { return {}; }
  /// Continues from the data of save(). Returns false if the data are invalid.
  virtual bool restore(std::span<const std::uint8_t> /*saved*/) { return false; }
};

}  // namespace vat
