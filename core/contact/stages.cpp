#include "core/contact/stages.h"

#include "core/contact/contacts.h"
#include "core/contact/restitution.h"
#include "core/contact/walls.h"
#include "core/model/acting_forces.h"

namespace vat {
namespace {

void add_search_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (model.liquid_count > 0 && !model.is_coupled) {
    plan.add("find_contacts", {position, liquid_cells}, {contact_list}, &find_contacts);
  } else {
    plan.add("find_contacts", {position}, {contact_list}, &find_contacts);
  }
}

void add_push_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  const bool has_contacts = has_contact_forces(model);
  if (!model.has_restitution) {
    if (has_contacts) {
      plan.add("contacts", {position, velocity, contact_list, force}, {force}, &add_contacts);
    }
  } else if (has_contacts) {
    plan.add("find_contact_mobilities", {position, rigid_state, contact_list}, {mobility},
             &find_contact_mobilities);
    plan.add("contacts", {position, velocity, rigid_state, contact_list, mobility, force}, {force},
             &add_contacts);
  } else if (!model.walls.empty()) {
    plan.add("find_contact_mobilities", {position, rigid_state}, {mobility},
             &find_contact_mobilities);
  }
}

}  // namespace

void add_contact_stages(const Model& model, PlanBuilder& plan) {
  if (model.contact_reach > 0) add_search_stages(model, plan);
  add_push_stages(model, plan);
}

void add_wall_stages(const Model& model, PlanBuilder& plan) {
  using enum Column;
  if (!has_wall_forces(model)) return;
  if (model.has_restitution) {
    plan.add("walls", {position, velocity, rigid_state, mobility, force}, {force},
             &add_wall_forces);
  } else {
    plan.add("walls", {position, velocity, force}, {force}, &add_wall_forces);
  }
}

}  // namespace vat
