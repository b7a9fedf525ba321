#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/types.h"

namespace vat {

struct SimulationContent;

/// The content of a simulation at one time, sufficient to continue with the same bits. It is
/// constant: copies share their content, and all threads may read it.
class Snapshot {
 public:
  Snapshot(const Snapshot&);
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(const Snapshot&);
  Snapshot& operator=(Snapshot&&) noexcept;
  ~Snapshot();

  /// Simulation::state_hash() at the time of the snapshot.
  std::uint64_t state_hash() const;
  /// Simulation::scene() at the time of the snapshot.
  const Scene& scene() const;
  /// Bytes for Simulation::load(): scene, state and commands in force. A particle takes 48 bytes;
  /// 8 more in incompressible liquids, 24 more with velocity Verlet, 64 more in scenes with inflow,
  /// outflow or melting. If some bodies sleep, the others count twice.
  std::vector<std::uint8_t> to_bytes() const;

 private:
  friend class Simulation;
  Snapshot(std::shared_ptr<const SimulationContent> content, BodyId next_id,
           InstructionSet instructions);
  std::shared_ptr<const SimulationContent> content_;
  BodyId next_id_;
  InstructionSet instructions_;
};

}  // namespace vat
