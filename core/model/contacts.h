#pragma once

#include "core/model/model.h"

namespace vat {

/// Fills the tables of contact laws and what follows from them: reach, exclusions, flags. Bodies,
/// particles and springs must be in the model already.
void compile_contacts(Model& model);

/// Brings them up to date where nothing has changed but where this body starts.
void compile_contacts_of_moved(Model& model, const ModelBody& body);

}  // namespace vat
