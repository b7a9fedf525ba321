#pragma once

#include "core/model/model.h"

namespace vat {

/// Adds the static springs of deformable bodies. The model must contain its bodies and particles.
void add_springs(Model& model);

/// Fills Model::implicit_places and ModelBody::spring_width. The model must contain its springs.
void order_implicit_springs(Model& model);

/// Adds the cells of deformable bodies with a bulk modulus.
void add_cells(Model& model);

/// Finds the springs with a maximum length and assigns a colour to each. The colour of a spring is
/// the first colour that no other spring of its two particles has. The model must contain its
/// springs.
void find_limited_springs(Model& model);

/// Fills the tables of contact laws, and the reach, exclusions and flags that follow from them. The
/// model must contain its bodies, particles and springs.
void compile_contacts(Model& model);

/// Updates the tables of compile_contacts() after a change of the initial position of `body` only.
void compile_contacts_of_moved(Model& model, const ModelBody& body);

/// Fills the data of surface tension if any liquid body has surface tension. The model must contain
/// its bodies and liquids.
void compile_surface_tension(Model& model);

}  // namespace vat
