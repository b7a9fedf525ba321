#include "core/sleep/sleepers.h"

#include <algorithm>

#include "core/laws/vat_motion.h"
#include "core/model/compile.h"
#include "core/sleep/islands.h"
#include "core/stepping/step_plan.h"
#include "core/support/check.h"

namespace vat {

Sleepers::Sleepers(std::shared_ptr<const Model> of_all, Configuration all,
                   std::vector<Index> sleeping)
    : model(std::move(of_all)), configuration(std::move(all)), islands(std::move(sleeping)) {
  const auto is_awake = [&](Index particle) { return islands[model->body[particle]] == kAwake; };
  std::erase_if(configuration.contacts, [&](const ContactImpulse& contact) {
    if (!is_awake(contact.particle)) return false;
    return contact.other < kWallCount || is_awake(static_cast<Index>(contact.other - kWallCount));
  });
  std::vector<Index> bodies;
  for (Index b = 0; b < islands.size(); ++b) {
    if (islands[b] != kAwake) bodies.push_back(b);
  }
  if (const Real reach = greatest_reach(*model); reach > 0) {
    resting.build(*model, configuration.position, bodies, waking_distance(reach, 0, 0));
  }
}

void settle_still_bodies(const Model& model, const Configuration& at, std::vector<Index>& islands) {
  const auto is_still_body = [&](Index b) { return is_still(model, model.bodies[b], at); };
  bool all_sleep = true;
  for (Index b = 0; b < islands.size(); ++b) {
    all_sleep = all_sleep && (islands[b] != kAwake || is_still_body(b));
  }
  for (Index b = 0; b < islands.size(); ++b) {
    if (is_still_body(b)) islands[b] = all_sleep ? b : kAwake;
  }
}

std::shared_ptr<const Model> compile_awake(const Model& model, const std::vector<Index>& islands) {
  VAT_CHECK(islands.size() == model.bodies.size());
  Scene scene = model.scene;
  scene.bodies.clear();
  std::vector<BodyId> ids;
  std::vector<std::shared_ptr<const SampledBody>> samples;
  for (std::size_t b = 0; b < islands.size(); ++b) {
    if (islands[b] != kAwake) continue;
    scene.bodies.push_back(model.scene.bodies[b]);
    ids.push_back(model.bodies[b].id);
    samples.push_back(model.bodies[b].sample);
  }
  std::erase_if(scene.emitters, [&](const Emitter& emitter) {
    return std::ranges::find(scene.bodies, emitter.body, &BodyDescription::name) ==
           scene.bodies.end();
  });
  auto awake = compile(std::move(scene), ids, std::move(samples), &model);
  forget_samples(*awake);
  return awake;
}

void stop(const Model& model, const std::vector<Index>& islands, Configuration& at) {
  VAT_CHECK(islands.size() == model.bodies.size());
  for (std::size_t b = 0; b < islands.size(); ++b) {
    if (islands[b] == kAwake) continue;
    const ModelBody& body = model.bodies[b];
    for (Index i = body.particles.begin; i < body.particles.end; ++i) at.velocity[i].setZero();
    if (body.kind != BodyKind::rigid) continue;
    at.rigid[body.rigid].momentum.setZero();
    at.rigid[body.rigid].angular_momentum.setZero();
  }
}

}  // namespace vat
