#pragma once

#include <optional>
#include <vector>

#include "core/model/model.h"
#include "core/state/state.h"

/// Copies of the state of single bodies between models.
namespace vat {

/// A model, with one of its bodies.
struct Placed {
  const Model& model;
  const ModelBody& body;
};

/// Copies the state of a body from the columns of one model to those of another. `kept`, if given,
/// are the particles that remain; further particles of the new body keep their initial state.
/// Contacts by projection are not copied.
void carry_over(const Placed& from, const Configuration& source, const Placed& to,
                const std::optional<std::vector<Index>>& kept, Configuration& target);

/// Zero forces with the column lengths of the model.
Forces no_forces(const Model& model);

/// The following functions take two models of one scene: a `whole`, and a `part` with some of its
/// bodies in the same order.

/// The configuration of the bodies of the part. Contacts with other bodies are left out.
Configuration part_of(const Model& whole, const Configuration& source, const Model& part);
/// Writes the configuration of the part back, except its contacts.
void write_part(const Model& part, const Configuration& source, const Model& whole,
                Configuration& target);
/// Adds the contacts of the part to those of other bodies.
void add_contacts_of_part(const Model& part, const Configuration& source, const Model& whole,
                          Configuration& target);
/// Forces on the bodies of the part.
Forces forces_of_part(const Model& whole, const Forces& source, const Model& part);

}  // namespace vat
