#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// What belongs to single bodies in the columns of a state.
namespace vat {

/// One of a scene's models, with one of its bodies.
struct Placed {
  const Model& model;
  const ModelBody& body;
};

/// Copies the state of a body from one model's columns to another's; what its sample has beyond
/// `kept`, where that is given, is where it starts already. Contacts by projection are left alone.
void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                const std::optional<std::vector<Index>>& kept, Configuration& target);

/// With a column's length, and nothing else in it.
Forces no_forces(const Model& model);

/// What follows is of two models of one scene, a `whole` and a `part` that has some of its bodies,
/// in the same order.

/// The configuration of the part's bodies. Contacts with others are left out.
Configuration part_of(const Model& whole, const Configuration& source, const Model& part);
/// Writes it back, but for its contacts.
void write_part(const Model& part, const Configuration& source, const Model& whole,
                Configuration& target);
/// Adds its contacts to those of others.
void add_contacts_of_part(const Model& part, const Configuration& source, const Model& whole,
                          Configuration& target);
/// Forces on the part's bodies.
Forces forces_of_part(const Model& whole, const Forces& source, const Model& part);

}  // namespace vat
