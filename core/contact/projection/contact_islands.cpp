#include "core/contact/projection/contact_islands.h"

#include "core/model/model.h"

namespace vat {

void ContactIslands::find(const Model& model, std::span<const ContactConstraint> constraints) {
  constexpr Index kNone = ~Index{0};
  const auto number_of = [&](const ContactEnd& end) {
    return end.rigid == kNoParticle ? end.particle : model.free_count + end.rigid;
  };
  const std::size_t end_count = model.free_count + model.rigid_bodies.size();
  ends_.reset(end_count);
  root_.resize(constraints.size());
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const auto& [first, second] = constraints[c].ends;
    VAT_CHECK(first.inverse_mass > 0 || second.inverse_mass > 0);
    if (first.inverse_mass > 0 && second.inverse_mass > 0) {
      ends_.join(number_of(first), number_of(second));
    }
    root_[c] = number_of(first.inverse_mass > 0 ? first : second);
  }
  island_of_.assign(end_count, kNone);
  begin_.assign(1, 0);
  for (Index& root : root_) {
    root = ends_.root(root);
    if (island_of_[root] == kNone) {
      island_of_[root] = static_cast<Index>(begin_.size() - 1);
      begin_.push_back(0);
    }
    ++begin_[island_of_[root] + 1];
  }
  for (std::size_t island = 1; island < begin_.size(); ++island)
    begin_[island] += begin_[island - 1];
  contacts_.resize(constraints.size());
  // Each begin_[island] advances to the end of the island, which is the begin of the next one.
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    contacts_[begin_[island_of_[root_[c]]]++] = static_cast<Index>(c);
  }
  for (std::size_t island = begin_.size() - 1; island > 0; --island)
    begin_[island] = begin_[island - 1];
  begin_[0] = 0;
}

}  // namespace vat
