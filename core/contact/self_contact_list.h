#pragma once

#include <span>
#include <vector>

#include "core/contact/contact_search.h"
#include "core/contact/pair_table.h"

namespace vat {

struct StepContext;

/// A list of the particle pairs of one deformable body that are or may soon be in contact, for a
/// world without periodic axes. Rigid motions of the body do not invalidate the list. The list is
/// invalid when the shape of the body has changed too much.
class SelfContactList {
 public:
  explicit SelfContactList(const IndexRange& particles) : particles_(particles) {}

  /// Updates the list to contain all pairs up to `slack` [m] beyond their threshold. Returns
  /// whether a search was necessary. If a search throws an exception, the list is invalid.
  bool update(const StepContext& context, Real slack);
  /// Returns whether the list is valid for `slack` [m], so that update() would not search.
  /// Recomputes the rotation of the body if necessary.
  bool is_current(const StepContext& context, Real slack);

  const IndexRange& particles() const { return particles_; }
  /// Returns the entries of particle i of the body.
  std::span<const Index> of(Index i) const { return table_.of(i - particles_.begin); }
  std::size_t size() const { return table_.size(); }

 private:
  void fit(const std::vector<Vec3>& positions);
  /// Returns whether the deviation of each particle from the rigid motion is at most `distance`
  /// [m].
  bool is_within(const StepContext& context, Real distance);
  void search(const StepContext& context, Real skin);

  IndexRange particles_;
  PairTable table_;
  std::vector<Vec3> built_at_;  ///< positions of the body's particles
  Real skin_ = 0;               ///< range of the list beyond the thresholds; 0: no list [m]
  // The rigid motion since the search: x -> turn_ (x - from_) + to_.
  Mat3 turn_ = Mat3::Identity();
  Vec3 from_ = Vec3::Zero();
  Vec3 to_ = Vec3::Zero();
  // Buffers:
  SortedParticles sorted_;
  std::vector<Index> all_;
  std::vector<char> is_far_;  ///< by block
};

}  // namespace vat
