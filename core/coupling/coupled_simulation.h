#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/coupling/external_body.h"
#include "core/simulation/simulation.h"

namespace vat {

/// Simulation in which external code moves some bodies. In each nominal step,
///
/// 1. the scene takes its step. External bodies are free rigid bodies or free particles in it;
/// 2. their changes of momentum, without gravity, are the impulses of the scene;
/// 3. each ExternalBody advances with its impulses. Its motion replaces that of the scene.
///
/// The rest of the scene receives the opposite impulses, so that momentum is conserved to rounding.
/// With the same external bodies, results are bitwise equal for any number of threads.
/// core/coupling/COUPLING.md describes order, snapshots and limits.
///
///     CoupledSimulation coupled(Simulation::create(scene).value());
///     const BodyId bob = *coupled.simulation().find_body("bob");
///     if (Status attached = coupled.attach(bob, std::make_unique<Pendulum>()); !attached) ...
///     const Result<AdvanceReport> report = coupled.advance(100);
class CoupledSimulation {
 public:
  explicit CoupledSimulation(Simulation simulation);
  CoupledSimulation(CoupledSimulation&&) noexcept;
  CoupledSimulation& operator=(CoupledSimulation&&) noexcept;
  ~CoupledSimulation();

  /// Lets `body` move the body `id` from the current time on. Fails if
  ///
  /// - the body does not exist, is already attached, or is liquid;
  /// - the body is held, driven, has an axle, or melts later;
  /// - the body has springs, a bulk modulus or fixed particles, because the external code replaces
  ///   them;
  /// - the motion at the start is invalid; see HostInterface::set_body_motion().
  Status attach(BodyId id, std::unique_ptr<ExternalBody> body);
  /// Lets the scene move the body again, from its current motion. Fails if it is not attached.
  Status detach(BodyId id);

  /// Advances by `steps` nominal steps. If a step fails, the report states this, and the state is
  /// that before the failed step. Fails if an external body supplies an invalid motion. The
  /// coupling has then ended: all later calls fail with the same errors. The path of each error
  /// begins with "/bodies/NAME". The coupling also ends if an external body throws an exception.
  Result<AdvanceReport> advance(std::uint32_t steps);

  /// Returns the scene. Its snapshots do not contain the external bodies; see save().
  const Simulation& simulation() const { return simulation_; }
  /// Returns the commands that change the scene between steps. A body that is removed is detached.
  HostInterface& commands() { return simulation_; }

  /// Returns the bytes of the scene and the external bodies, for load(). Fails if an external body
  /// cannot be saved, or the coupling has ended. Codes: not_restorable, ended.
  Result<std::vector<std::uint8_t>> save() const;

  /// Function that returns the external body for the body with this name, or null.
  using MakeBody = std::function<std::unique_ptr<ExternalBody>(std::string_view name)>;
  /// Returns the coupled simulation of the bytes of save(), which continues bitwise equal. Fails
  /// like Simulation::load(), and if `make` or ExternalBody::restore() fails. Code: not_restored.
  static Result<CoupledSimulation> load(std::span<const std::uint8_t> bytes, const MakeBody& make,
                                        TaskRunner* runner = nullptr);

 private:
  struct Attached;
  Status check(BodyId id) const;
  void read_momenta();
  Status exchange(const CouplingInterval& interval);

  Simulation simulation_;
  std::vector<Attached> attached_;
  std::optional<Errors> ended_;
};

}  // namespace vat
