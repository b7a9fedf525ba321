#pragma once

#include <span>
#include <vector>

#include "core/contact/contact_search.h"
#include "core/contact/pair_table.h"

namespace vat {

struct StepContext;

/// The pairs of particles of one deformable body that are or may soon be in contact, in a world
/// that is not periodic. The list remains valid for all rigid motions of the body, until its shape
/// has changed too much.
class SelfContactList {
 public:
  explicit SelfContactList(const IndexRange& particles) : particles_(particles) {}

  /// Extends the list to pairs up to `slack` [m] beyond their threshold. Returns whether it
  /// searched. A failed search leaves no list.
  bool update(const StepContext& context, Real slack);
  /// Returns whether update() would not search. Determines the rotation of the body again if
  /// necessary.
  bool is_current(const StepContext& context, Real slack);

  const IndexRange& particles() const { return particles_; }
  /// The entries of particle i of the body.
  std::span<const Index> of(Index i) const { return table_.of(i - particles_.begin); }
  std::size_t size() const { return table_.size(); }

 private:
  void fit(const std::vector<Vec3>& positions);
  /// Returns whether all particles are within `distance` of the rigid motion.
  bool is_within(const StepContext& context, Real distance);
  void search(const StepContext& context, Real skin);

  IndexRange particles_;
  PairTable table_;
  std::vector<Vec3> built_at_;  ///< positions of the body's particles
  Real skin_ = 0;               ///< skin of the list; 0: no list [m]
  // The rigid motion since the search: x -> turn (x - from) + to.
  Mat3 turn_ = Mat3::Identity();
  Vec3 from_ = Vec3::Zero();
  Vec3 to_ = Vec3::Zero();
  // Buffers:
  SortedParticles sorted_;
  std::vector<Index> all_;
  std::vector<char> is_far_;  ///< by block
};

}  // namespace vat
