#pragma once

#include <span>
#include <vector>

#include "core/contact/projection/contact_constraint.h"
#include "core/support/disjoint_sets.h"

namespace vat {

/// A partition of contacts into islands. Contacts of different islands share no end that moves, so
/// that their impulses are independent. The islands and the contacts of an island are in the order
/// of the contacts.
class ContactIslands {
 public:
  void find(const Model& model, std::span<const ContactConstraint> constraints);
  std::size_t count() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  /// The indices of the contacts of an island.
  std::span<const Index> operator[](std::size_t island) const {
    return std::span(contacts_).subspan(begin_[island], begin_[island + 1] - begin_[island]);
  }

 private:
  DisjointSets ends_;             ///< free particles, then rigid bodies
  std::vector<Index> root_;       ///< by contact: an end of its island
  std::vector<Index> island_of_;  ///< by end: the island of which it is the root
  std::vector<Index> begin_;      ///< by island, and the total
  std::vector<Index> contacts_;   ///< by island
};

}  // namespace vat
