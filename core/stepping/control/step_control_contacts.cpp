#include "core/stepping/control/step_control_contacts.h"
#include "core/contact/scratch.h"

#include <algorithm>
#include <cmath>

#include "core/laws/contact_damping.h"
#include "core/laws/lennard_jones.h"
#include "core/laws/pair_direction.h"
#include "core/laws/vat_motion.h"
#include "core/numerics/error_model.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kStabilityMargin = 0.9;
constexpr Real kLocalMargin = 0.5;  // kicks with several periods have resonances below the limit

/// The parameters of the search.
struct ContactBoundSearch {
  const ForceModel& force_model;
  const Configuration& at;
  Real longest;
  Real gained_speed;  ///< by gravity, within `longest` [m/s]
  Real reach;
  VatMotion vat_motion;
  Real vat_speed;  ///< maximum [m/s]

  const Model& model() const { return force_model.model; }
};

void find_inverse_masses(const ContactBoundSearch& search, std::vector<Real>& inverse_mass) {
  const Model& model = search.model();
  inverse_mass.assign(model.inverse_mass.begin(), model.inverse_mass.end());
  for (std::size_t i = model.free_count; i < model.particle_count; ++i) {
    inverse_mass[i] = greatest_inverse_mass(model, static_cast<Index>(i), search.force_model.step,
                                            model.has_friction ? model.radius[i] : 0);
  }
}

bool acts(const SpringConstants& law) {
  return law.stiffness > 0 || law.damping > 0;
}

/// The time until two ends with the gap `gap` [m] can touch, with an approach speed of at most
/// `approach` [m/s].
Real time_to_touch(Real gap, Real approach) {
  return gap <= 0 ? 0 : gap / std::max(approach, std::numeric_limits<Real>::min());
}

/// A connection along `normal`, with friction across it, seen from an end with the share `share` of
/// it.
ContactPrediction look_at(const SpringConstants& law, const Friction& friction, Real threshold,
                          Real time, Real share, const Vec3& normal, Real normal_speed) {
  const Mat3 along = normal * normal.transpose();
  Mat3 damping = law.damping * along;
  if (friction.acts()) damping += friction.sticking * (Mat3::Identity() - along);
  return {share * law.stiffness * along, share * damping, time, normal_speed, threshold};
}

ContactPrediction look_at_pairs(const ContactBoundSearch& search,
                                const std::vector<Real>& inverse_mass, Index i) {
  ContactPrediction sum;
  if (inverse_mass[i] == 0) return sum;
  search.force_model.work.of<ContactForceScratch>().contacts.for_each(
      search.model(), search.at, i,
      [&](const Contact& contact) {
        const Index j = contact.other;
        const Vec3 velocity = search.at.velocity[i] - search.at.velocity[j];
        const Real approach = velocity.norm() + search.gained_speed;
        const Real time = time_to_touch(contact.distance - contact.threshold, approach);
        SpringConstants law{contact.stiffness, contact.damping};
        if (contact.layer > 0) {
          const Real nearest = std::max(Real{0}, contact.distance - approach * search.longest);
          law.stiffness = greatest_layer_slope(contact.stiffness, contact.layer, contact.threshold,
                                               std::min(nearest, contact.threshold));
        } else if (contact.damping_ratio > 0) {
          law.damping = damping_for(contact.damping_ratio, contact.stiffness,
                                    inverse_mass[i] + inverse_mass[j]);
        }
        if (time > search.longest || !acts(law)) return;
        const Vec3 normal =
            pair_direction(contact.x, contact.distance, i, j, search.model().scene.dimensions);
        sum.add(look_at(law, pair_friction(search.model(), i, j, law.stiffness), contact.threshold,
                        time, 1 + std::sqrt(inverse_mass[j] / inverse_mass[i]), normal,
                        contact.distance > 0 ? std::abs(velocity.dot(normal)) : velocity.norm()));
      },
      search.reach);
  return sum;
}

/// The maximum slope of a layer from the distance `nearest` from the wall to its reach.
Real greatest_wall_slope(const ContactLaw& law, Real reach, Real nearest) {
  const Real width = reach * law.layer / (1 + law.layer);
  return greatest_layer_slope(law.stiffness, width, reach, std::clamp(nearest, Real{0}, reach));
}

/// `inverse_mass`: that of the motion of the particle [1/kg].
ContactPrediction look_at_walls(const ContactBoundSearch& search, Real inverse_mass, Index i) {
  const Model& model = search.model();
  const Vat& vat = *model.scene.vat;
  const ContactLaw& law = model.wall_laws[model.material[i]];
  ContactPrediction sum;
  if (model.is_coupled && i < model.liquid_count) return sum;
  if (!acts({law.stiffness, law.damping})) return sum;
  const Real threshold = law.wall_threshold(model.radius[i]);
  for (const int wall : model.walls) {
    const Vec3 normal = wall_normal(wall);
    const Real speed = -search.at.velocity[i].dot(normal);
    const Real gap = wall_distance(vat, search.vat_motion, wall, search.at.position[i]) - threshold;
    const Real approach = std::max(Real{0}, speed + search.gained_speed + search.vat_speed);
    const Real time = time_to_touch(gap, approach);
    if (time > search.longest) continue;
    SpringConstants constants{law.stiffness, law.damping};
    if (law.layer > 0) {
      constants.stiffness =
          greatest_wall_slope(law, threshold, gap + threshold - approach * search.longest);
    } else if (law.damping_ratio > 0) {
      constants.damping = damping_for(law.damping_ratio, law.stiffness, inverse_mass);
    }
    sum.add(look_at(constants, wall_friction(model, i), threshold, time, 1, normal,
                    std::abs(speed + search.vat_motion.velocity.dot(normal))));
  }
  return sum;
}

}  // namespace

// Forces with kinks limit all methods to order 2. A contact that begins and ends within steps
// changes the separation speed by up to z^2 / 8.
Real contact_phase(const Numerics& numerics) {
  return std::min(resolving_phase_of_places(numerics), std::sqrt(8 * numerics.tolerance));
}

namespace {

/// The step for `contacts` only, and with `all` other forces.
Real allowed_step(const Numerics& numerics, const ContactPrediction& prediction,
                  const Oscillation& contacts, const Oscillation& all) {
  const Real rate = std::sqrt(contacts.omega2 + contacts.rate * contacts.rate);
  if (rate == 0) return std::numeric_limits<Real>::infinity();
  const Real amplitude = prediction.speed / rate;
  const Real share = std::min(Real{1}, amplitude / (kFullAmplitude * prediction.threshold));
  const Real resolving = contact_phase(numerics) / (rate * std::sqrt(share));
  const Real step = std::min(safe_step(numerics, all), resolving);
  // Local levels are constant during a step, so that contacts may begin at any time in the step.
  return numerics.control == StepControl::local ? step : std::max(prediction.time, step);
}

using Mat6 = Eigen::Matrix<Real, 6, 6>;

/// An upper bound of the eigenvalues of a symmetric, positive semi-definite matrix, (tr A^8)^(1/8).
/// It is at most a quarter too large, and cheaper than the eigenvalues.
Real greatest_eigenvalue(Mat6 matrix) {
  const Real trace = matrix.trace();
  if (!(trace > 0)) return 0;
  matrix /= trace;
  for (int squaring = 0; squaring < 3; ++squaring) matrix = (matrix * matrix).eval();
  return trace * std::sqrt(std::sqrt(std::sqrt(matrix.trace())));
}

/// An upper bound of the eigenvalues of a symmetric matrix; exact for springs along the axes.
Real greatest_row(const Mat3& matrix) {
  return matrix.cwiseAbs().rowwise().sum().maxCoeff();
}

Real particle_step(const Numerics& numerics, const ContactPrediction& prediction, Real inverse_mass,
                   const Oscillation& own) {
  const Oscillation contacts{inverse_mass * greatest_row(prediction.stiffness),
                             inverse_mass * greatest_row(prediction.damping)};
  return allowed_step(numerics, prediction, contacts, own + contacts);
}

/// The sum of the contacts' constants K at arms a from the centre of mass, for the motions (u,
/// theta) of a rigid body, in which a particle moves by u + theta x a: the matrix J^T K J.
struct RigidLoad {
  Mat3 linear = Mat3::Zero();
  Mat3 mixed = Mat3::Zero();
  Mat3 angular = Mat3::Zero();

  void add(const Mat3& constants, const Mat3& cross) {
    const Mat3 turned = cross * constants;
    linear += constants;
    mixed += turned;
    angular += turned * cross.transpose();
  }
  /// An upper bound of the eigenvalues of M^-1 J^T K J, with I^-1 = turning turning^T.
  Real greatest(Real inverse_mass, const Mat3& turning) const {
    const Mat3 scaled = std::sqrt(inverse_mass) * turning.transpose() * mixed;
    Mat6 matrix;
    matrix << inverse_mass * linear, scaled.transpose(), scaled,
        turning.transpose() * angular * turning;
    return greatest_eigenvalue(matrix);
  }
};

Mat3 cross_matrix(const Vec3& a) {
  Mat3 cross;
  cross << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return cross;
}

Real rigid_step(const ContactBoundSearch& search, const std::vector<ContactPrediction>& predictions,
                std::size_t body) {
  const RigidModel& rigid = search.model().rigid_bodies[body];
  const RigidState& now = search.at.rigid[body];
  ContactPrediction sum;
  RigidLoad stiffness;
  RigidLoad damping;
  for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
    const ContactPrediction& own = predictions[i - search.model().free_count];
    if (own.is_empty()) continue;
    sum.add(own);
    const Mat3 cross = cross_matrix(search.at.position[i] - now.center_of_mass);
    stiffness.add(own.stiffness, cross);
    damping.add(own.damping, cross);
  }
  if (sum.is_empty()) return std::numeric_limits<Real>::infinity();
  const Mat3 turning = (now.orientation * rigid.principal_axes).toRotationMatrix() *
                       rigid.inverse_moments.cwiseSqrt().asDiagonal();
  const Oscillation contacts{stiffness.greatest(rigid.inverse_mass, turning),
                             damping.greatest(rigid.inverse_mass, turning)};
  return allowed_step(search.model().scene.numerics, sum, contacts, contacts);
}

}  // namespace

Real safe_step(const Numerics& numerics, const Oscillation& oscillation) {
  if (numerics.control == StepControl::local) {  // damping uses the velocity before the kick
    return kLocalMargin * stable_step(IntegratorId::symplectic_euler, oscillation);
  }
  const Real step = stable_step(numerics.integrator, oscillation);
  return step > 0 ? kStabilityMargin * step : std::numeric_limits<Real>::infinity();
}

void ContactPrediction::add(const ContactPrediction& other) {
  stiffness += other.stiffness;
  damping += other.damping;
  time = std::min(time, other.time);
  speed = std::max(speed, other.speed);
  threshold = std::min(threshold, other.threshold);
}

void find_contact_steps(const ForceModel& f, const Configuration& at, Real time,
                        const ContactHorizon& ahead, const StepBounds& bounds,
                        ContactScratch& scratch, std::vector<Real>& particle_steps,
                        std::vector<Real>& rigid_steps) {
  const Model& model = f.model;
  VAT_CHECK(particle_steps.size() == f.model.free_count &&
            rigid_steps.size() == f.model.rigid_bodies.size());
  if (model.contact_reach <= 0 && model.walls.empty()) return;
  const ContactBoundSearch search{
      f,
      at,
      ahead.longest,
      model.scene.forces.gravity ? model.scene.gravity.norm() * ahead.longest : 0,
      ahead.reach,
      model.scene.vat ? vat_motion(*model.scene.vat, time) : VatMotion{},
      model.scene.vat ? greatest_vat_speed(*model.scene.vat, time) : 0};
  // Coupled liquid has no springs at walls.
  const Index first = model.is_coupled && model.contact_reach <= 0 ? model.liquid_count : 0;
  if (first == model.particle_count) return;
  find_inverse_masses(search, scratch.inverse_mass);
  scratch.prediction.resize(model.particle_count - model.free_count);
  for_blocks(f.runner, model.particle_count - first, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Index i = first + static_cast<Index>(k);
      ContactPrediction prediction;
      if (model.contact_reach > 0) prediction = look_at_pairs(search, scratch.inverse_mass, i);
      if (!model.walls.empty()) {
        prediction.add(look_at_walls(search, scratch.inverse_mass[i], i));
      }
      if (i >= model.free_count) {
        scratch.prediction[i - model.free_count] = prediction;
        continue;
      }
      if (model.inverse_mass[i] == 0 || prediction.is_empty()) continue;
      particle_steps[i] = std::min(
          particle_steps[i],
          particle_step(model.scene.numerics, prediction, model.inverse_mass[i], bounds.own[i]));
    }
  });
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    if (model.rigid_bodies[b].is_held(f.step)) continue;
    rigid_steps[b] = std::min(rigid_steps[b], rigid_step(search, scratch.prediction, b));
  }
}

}  // namespace vat
