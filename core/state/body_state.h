#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// Functions that copy the state of single bodies between models.
namespace vat {

/// A model and one of its bodies.
struct Placed {
  const Model& model;
  const ModelBody& body;
};

/// Copies the state of a body from the arrays of one model to the arrays of another. `kept`, if
/// present, lists the particles to copy; the remaining particles of the target body are unchanged.
/// Contacts by projection are not copied.
void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                const std::optional<std::vector<Index>>& kept, Configuration& target);

/// Returns zero forces, with the array lengths of `model`.
Forces no_forces(const Model& model);

/// The following functions have two models of one scene as arguments: `whole`, and `part` with some
/// of the bodies of `whole`, in the same order.

/// Returns the configuration of the bodies of `part`, without their contacts with other bodies.
Configuration part_of(const Model& whole, const Configuration& source, const Model& part);
/// Copies the configuration of the bodies of `part` to `target`, except their contacts.
void write_part(const Model& part, const Configuration& source, const Model& whole,
                Configuration& target);
/// Adds the contacts of the bodies of `part` to the contacts in `target`.
void add_contacts_of_part(const Model& part, const Configuration& source, const Model& whole,
                          Configuration& target);
/// Returns the forces on the bodies of `part`.
Forces forces_of_part(const Model& whole, const Forces& source, const Model& part);

}  // namespace vat
