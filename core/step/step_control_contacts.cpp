#include "core/step/step_control_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/forces/contact_search.h"
#include "core/forces/pair_direction.h"
#include "core/forces/vat_motion.h"
#include "core/scene/error_model.h"

namespace vat {
namespace {

constexpr Real kStabilityMargin = 0.9;
constexpr Real kLocalMargin = 0.5;  // kicks at several periods have resonances below the limit
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

/// What a step's length depends on beside the state.
struct Search {
  const ForceModel& force_model;
  const Configuration& at;
  Real longest;
  Real gained_speed;  ///< by gravity, within `longest` [m/s]
  Real reach;
  VatMotion vat_motion;
  Real vat_speed;  ///< the greatest [m/s]

  const Model& model() const { return force_model.model; }
};

/// 1/m of a free particle; of a rigid one 1/M + |x|^2 / I, at most that of any direction.
void find_inverse_masses(const Search& search, std::vector<Real>& inverse_mass) {
  const Model& model = search.model();
  inverse_mass.assign(model.inverse_mass.begin(), model.inverse_mass.end());
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    const Real turning = rigid.inverse_moments.maxCoeff();
    for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
      inverse_mass[i] =
          rigid.inverse_mass + turning * model.local_position[i - model.free_count].squaredNorm();
    }
  }
}

/// A connection whose two ends are `gap` [m] from touching, seen from an end where forces have
/// `weight` [1/kg] and approaching at most at `approach` [m/s].
ContactOutlook look_out(const Search& search, const SpringConstants& law, Real threshold, Real gap,
                        Real weight, Real approach, Real normal_speed) {
  ContactOutlook outlook;
  if (law.stiffness == 0 && law.damping == 0) return outlook;
  const Real time = gap <= 0 ? 0 : gap / std::max(approach, std::numeric_limits<Real>::min());
  if (time > search.longest) return outlook;
  outlook.time = time;
  outlook.bound = {law.stiffness * weight, law.damping * weight};
  outlook.speed = normal_speed;
  outlook.threshold = threshold;
  return outlook;
}

ContactOutlook look_at_pairs(const Search& search, const std::vector<Real>& inverse_mass, Index i) {
  ContactOutlook sum;
  for_each_contact(
      search.model(), search.force_model.work, search.at, i,
      [&](const Contact& contact) {
        const Index j = contact.other;
        const Vec3 velocity = search.at.velocity[i] - search.at.velocity[j];
        const Real distance = contact.distance;
        const Real normal_speed =
            distance > 0 ? std::abs(velocity.dot(contact.x)) / distance : velocity.norm();
        const Real weight = inverse_mass[i] + std::sqrt(inverse_mass[i] * inverse_mass[j]);
        sum.add(look_out(search, {contact.stiffness, contact.damping}, contact.threshold,
                         distance - contact.threshold, weight,
                         velocity.norm() + search.gained_speed, normal_speed));
      },
      search.reach);
  return sum;
}

ContactOutlook look_at_walls(const Search& search, const std::vector<Real>& inverse_mass, Index i) {
  const Model& model = search.model();
  const Vat& vat = *model.scene.vat;
  const ContactLaw& law = model.wall_laws[model.material[i]];
  const Real threshold = law.threshold > 0 ? law.threshold : model.radius[i];
  ContactOutlook sum;
  for (const int wall : model.walls) {
    const Vec3 normal = wall_normal(wall);
    const Real speed = -search.at.velocity[i].dot(normal);
    const Real gap = wall_distance(vat, search.vat_motion, wall, search.at.position[i]) - threshold;
    sum.add(look_out(search, {law.stiffness, law.damping}, threshold, gap, inverse_mass[i],
                     std::max(Real{0}, speed + search.gained_speed + search.vat_speed),
                     std::abs(speed + search.vat_motion.velocity.dot(normal))));
  }
  return sum;
}

/// A force with a kink is of order 2 with any method: a contact that begins and ends within steps
/// changes the speed of parting by up to z^2 / 8.
Real contact_phase(const Numerics& numerics) {
  return std::min(resolving_phase(numerics.integrator, numerics.tolerance),
                  std::sqrt(8 * numerics.tolerance));
}

Real allowed_step(const Numerics& numerics, const ContactOutlook& outlook) {
  if (outlook.time == kInfinity) return kInfinity;
  const Real rate = std::sqrt(outlook.bound.omega2 + outlook.bound.rate * outlook.bound.rate);
  if (rate == 0) return kInfinity;
  const Real amplitude = outlook.speed / rate;
  const Real share = std::min(Real{1}, amplitude / (kFullAmplitude * outlook.threshold));
  const Real resolving = contact_phase(numerics) / (rate * std::sqrt(share));
  const Real step = std::min(safe_step(numerics, outlook.bound), resolving);
  // Local levels are for a whole step, whenever in it the contact begins.
  return numerics.control == StepControl::local ? step : std::max(outlook.time, step);
}

Real greatest_vat_speed(const Model& model) {
  if (!model.scene.vat || !model.scene.vat->motion) return 0;
  const SlideMotion& motion = *model.scene.vat->motion;
  return std::numbers::pi * std::abs(motion.stroke) / motion.period;
}

}  // namespace

Real safe_step(const Numerics& numerics, const Oscillation& oscillation) {
  if (numerics.control == StepControl::local) {  // damping is that of the velocity before the kick
    return kLocalMargin * stable_step(IntegratorId::symplectic_euler, oscillation);
  }
  const Real step = stable_step(numerics.integrator, oscillation);
  return step > 0 ? kStabilityMargin * step : kInfinity;
}

void ContactOutlook::add(const ContactOutlook& other) {
  bound = bound + other.bound;
  time = std::min(time, other.time);
  speed = std::max(speed, other.speed);
  threshold = std::min(threshold, other.threshold);
}

void find_contact_steps(const ForceModel& f, const Configuration& at, Real time, Real longest,
                        Real reach, ContactScratch& scratch, std::vector<Real>& particle_step,
                        std::vector<Real>& rigid_step) {
  const Model& model = f.model;
  if (model.contact_reach <= 0 && model.walls.empty()) return;
  const Search search{f,
                      at,
                      longest,
                      model.scene.forces.gravity ? model.scene.gravity.norm() * longest : 0,
                      reach,
                      model.scene.vat ? vat_motion(*model.scene.vat, time) : VatMotion{},
                      greatest_vat_speed(model)};
  find_inverse_masses(search, scratch.inverse_mass);
  scratch.outlook.resize(model.particle_count);
  for_blocks(f.runner, model.particle_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      ContactOutlook outlook;
      if (model.contact_reach > 0) outlook = look_at_pairs(search, scratch.inverse_mass, i);
      if (!model.walls.empty()) outlook.add(look_at_walls(search, scratch.inverse_mass, i));
      scratch.outlook[i] = outlook;
      if (i >= model.free_count || model.inverse_mass[i] == 0) continue;
      particle_step[i] = std::min(particle_step[i], allowed_step(model.scene.numerics, outlook));
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const IndexRange particles = model.rigid_bodies[b].particles;
    ContactOutlook sum;
    for (Index i = particles.begin; i < particles.end; ++i) sum.add(scratch.outlook[i]);
    rigid_step[b] = std::min(rigid_step[b], allowed_step(model.scene.numerics, sum));
  }
}

}  // namespace vat
