#pragma once

#include "core/model/model.h"

namespace vat {

/// Fills the tables of contact laws, and the reach, exclusions and flags that follow from them. The
/// model must have its bodies, particles and springs.
void compile_contacts(Model& model);

/// Updates the tables after a change of the initial position of this body only.
void compile_contacts_of_moved(Model& model, const ModelBody& body);

}  // namespace vat
