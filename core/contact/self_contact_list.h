#pragma once

#include <span>
#include <vector>

#include "core/contact/contact_search.h"
#include "core/contact/pair_table.h"

namespace vat {

struct StepContext;

/// The pairs of particles of one deformable body that are in contact or soon may be; of a world
/// that does not repeat itself. Stays whole however far the body moves and turns, until its shape
/// has changed too much.
class SelfContactList {
 public:
  explicit SelfContactList(const IndexRange& particles) : particles_(particles) {}

  /// From now on the list has every pair up to `slack` [m] beyond its threshold; true where it had
  /// to search. A search that fails leaves none.
  bool update(const StepContext& context, Real slack);
  /// Whether update() would not have to search. Finds out anew how the body has turned, if it must.
  bool is_current(const StepContext& context, Real slack);

  const IndexRange& particles() const { return particles_; }
  /// The others of particle i of the body.
  std::span<const Index> of(Index i) const { return table_.of(i - particles_.begin); }
  std::size_t size() const { return table_.size(); }

 private:
  void fit(const std::vector<Vec3>& positions);
  /// Whether no particle is further from where the rigid motion has it.
  bool is_within(const StepContext& context, Real distance);
  void search(const StepContext& context, Real skin);

  IndexRange particles_;
  PairTable table_;
  std::vector<Vec3> built_at_;  ///< of the body's particles
  Real skin_ = 0;               ///< of the list; 0: there is none [m]
  // The rigid motion since then: x -> turn (x - from) + to.
  Mat3 turn_ = Mat3::Identity();
  Vec3 from_ = Vec3::Zero();
  Vec3 to_ = Vec3::Zero();
  // Scratch.
  SortedParticles sorted_;
  std::vector<Index> all_;
  std::vector<char> is_far_;  ///< by block
};

}  // namespace vat
