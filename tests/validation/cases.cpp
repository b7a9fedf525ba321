#include "tests/validation/cases.h"

#include <iterator>

namespace vat::validation {

namespace {

std::vector<Case> collect_cases() {
  std::vector<Case> cases;
  for (const auto group : {oscillator_cases,
                           chain_cases,
                           static_cases,
                           pendulum_cases,
                           cantilever_cases,
                           free_spin_cases,
                           implicit_spring_cases,
                           plastic_spring_cases,
                           kept_length_cases,
                           rigid_top_cases,
                           rigid_contact_cases,
                           rigid_friction_cases,
                           rigid_projection_cases,
                           rigid_sampling_cases,
                           liquid_lattice_cases,
                           liquid_channel_cases,
                           liquid_drop_cases,
                           liquid_surface_cases,
                           liquid_column_cases,
                           liquid_dam_break_cases,
                           tait_dam_break_cases,
                           liquid_tank_cases,
                           liquid_piston_cases,
                           two_liquid_cases,
                           liquid_jet_cases,
                           liquid_vortex_cases,
                           liquid_outlet_cases,
                           liquid_solver_cases,
                           interaction_impact_cases,
                           interaction_buoyancy_cases,
                           tait_body_cases,
                           soft_bed_cases}) {
    std::ranges::move(group(), std::back_inserter(cases));
  }
  return cases;
}

}  // namespace

const std::vector<Case>& all_cases() {
  static const std::vector<Case> kCases = collect_cases();
  return kCases;
}

}  // namespace vat::validation
