#pragma once

#include "core/model/model.h"

namespace vat {

/// Adds the static springs of deformable bodies. The model must have its bodies and particles.
void add_springs(Model& model);

/// Adds the cells of deformable bodies with a bulk modulus.
void add_cells(Model& model);

/// Finds the springs with a maximum length, and colours them. Each gets the first colour that no
/// other spring of its particles has. The model must have its springs.
void find_limited_springs(Model& model);

/// Fills the tables of contact laws, and the reach, exclusions and flags that follow from them. The
/// model must have its bodies, particles and springs.
void compile_contacts(Model& model);

/// Updates the tables after a change of the initial position of this body only.
void compile_contacts_of_moved(Model& model, const ModelBody& body);

/// Fills the data of surface tension if some liquid body has it. The model must have its bodies and
/// liquids.
void compile_surface_tension(Model& model);

}  // namespace vat
