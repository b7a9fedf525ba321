#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/types.h"

namespace vat {

struct SimulationContent;

/// State of a simulation at one time, from which the simulation continues with bitwise equal
/// results. A snapshot is constant: copies share the content, and all threads may read it.
class Snapshot {
 public:
  Snapshot(const Snapshot&);
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(const Snapshot&);
  Snapshot& operator=(Snapshot&&) noexcept;
  ~Snapshot();

  /// Returns Simulation::state_hash() at the time of the snapshot.
  std::uint64_t state_hash() const;
  InstructionSet instruction_set() const { return instructions_; }
  /// Returns Simulation::scene() at the time of the snapshot.
  const Scene& scene() const;
  /// Returns bytes for Simulation::load(): scene, state and active commands. A particle needs 48
  /// bytes. Incompressible liquids need 8 more, velocity Verlet 24 more, and scenes with inflow,
  /// outflow or melting 64 more bytes. If any body sleeps, the bytes of the awake bodies are stored
  /// twice.
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
