#pragma once

#include <string>
#include <vector>

#include "tests/validation/case.h"

namespace vat::validation {

/// Returns all cases in the order of the table. Each group has a file in cases/. A new group is
/// declared here and added in cases.cpp.
const std::vector<Case>& all_cases();

std::vector<Case> oscillator_cases();
std::vector<Case> chain_cases();
std::vector<Case> static_cases();
std::vector<Case> pendulum_cases();
std::vector<Case> cantilever_cases();
std::vector<Case> free_spin_cases();
std::vector<Case> implicit_spring_cases();
std::vector<Case> plastic_spring_cases();
std::vector<Case> kept_length_cases();
std::vector<Case> rigid_top_cases();
std::vector<Case> rigid_contact_cases();
std::vector<Case> rigid_friction_cases();
std::vector<Case> rigid_projection_cases();
std::vector<Case> rigid_sampling_cases();
std::vector<Case> liquid_lattice_cases();
std::vector<Case> liquid_channel_cases();
std::vector<Case> liquid_drop_cases();
std::vector<Case> liquid_surface_cases();
std::vector<Case> liquid_column_cases();
std::vector<Case> liquid_dam_break_cases();
std::vector<Case> liquid_tank_cases();
std::vector<Case> liquid_piston_cases();
std::vector<Case> two_liquid_cases();
std::vector<Case> liquid_jet_cases();
std::vector<Case> liquid_vortex_cases();
std::vector<Case> liquid_outlet_cases();
std::vector<Case> liquid_solver_cases();
std::vector<Case> interaction_impact_cases();
std::vector<Case> interaction_buoyancy_cases();
std::vector<Case> tait_body_cases();
std::vector<Case> soft_bed_cases();
std::vector<Case> tait_dam_break_cases();

}  // namespace vat::validation
