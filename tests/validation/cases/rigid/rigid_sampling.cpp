#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/order.h"

namespace vat::validation {

namespace {

/// A solid with known principal moments per mass.
struct Solid {
  const char* name;
  Shape shape;
  Vec3 moments;                ///< [m^2]
  std::vector<Real> spacings;  ///< [m]
  Real order;
  Tolerance tolerance;
};

/// Returns spacings that are not simple fractions of the sizes. The error then varies around its
/// trend.
std::vector<Real> uneven_spacings() {
  std::vector<Real> spacings;
  for (int i = 0; i < 10; ++i) spacings.push_back(0.09 * std::pow(0.8, i));
  return spacings;
}

std::vector<Solid> solids() {
  const Real r = 0.15;
  const Real h = 0.4;
  const Real across = r * r / 4 + h * h / 12;
  const Tolerance midpoints = within(0.2, "order of the midpoint rule on cells that fit");
  const Tolerance cut = at_least("cells that the surface cuts, a volume that falls as the spacing");
  return {{"box",
           BoxShape{Vec3::Zero(), {0.4, 0.3, 0.2}},
           Vec3(0.3 * 0.3 + 0.2 * 0.2, 0.4 * 0.4 + 0.2 * 0.2, 0.4 * 0.4 + 0.3 * 0.3) / 12,
           {0.1, 0.05, 0.025, 0.0125},
           2,
           midpoints},
          {"sphere", SphereShape{Vec3::Zero(), 0.2}, Vec3::Constant(0.4 * 0.2 * 0.2),
           uneven_spacings(), 1, cut},
          {"cylinder", CylinderShape{Vec3::Zero(), Vec3::UnitZ(), r, h},
           Vec3(across, across, r * r / 2), uneven_spacings(), 1, cut}};
}

/// Returns the moments per mass [m^2] from the angular momentum of a rotation about each axis.
Vec3 sampled_moments(Sheet& sheet, const Shape& shape, Real spacing, Row& row) {
  Vec3 moments;
  for (int axis = 0; axis < 3; ++axis) {
    Scene scene = load_scene("RIG-sampled");
    scene.bodies[0].shape = shape;
    scene.bodies[0].spacing = spacing;
    scene.bodies[0].angular_velocity = Vec3::Unit(axis);
    const Run run = sheet.start(scene);
    const BodyDiagnostics body = run.diagnostics().bodies[0];
    moments[axis] = body.angular_momentum[axis] / body.mass;
    row.state_hash = run.state_hash();
  }
  return moments;
}

void run_sampled(Sheet& sheet) {
  for (const Solid& solid : solids()) {
    std::vector<Real> errors;
    Row row{
        .metric = std::string("order of convergence of the inertia in the spacing, ") + solid.name,
        .reference = solid.order,
        .tolerance = solid.tolerance};
    for (const Real spacing : solid.spacings) {
      const Vec3 moments = sampled_moments(sheet, solid.shape, spacing, row);
      errors.push_back((moments - solid.moments).norm() / solid.moments.norm());
    }
    row.measured = observed_order(solid.spacings, errors);
    sheet.add(row);
    row.metric = std::string("relative error of the inertia at the least spacing, ") + solid.name;
    row.reference = 0;
    row.measured = errors.back();
    row.tolerance = within(solid.spacings.back() / 0.2, "spacing over the half-width");
    sheet.add(row);
  }
}

struct Place {
  Vec3 center;
  Quat orientation;
};

Place sampling_place_of(Sheet& sheet, IntegratorId integrator, Real step, Row& row,
                        Real* energy = nullptr) {
  Scene scene = load_scene("RIG-torque");
  scene.numerics.integrator = integrator;
  scene.numerics.step = step;
  scene.numerics.tick = step;
  Run run = sheet.start(scene);
  const Real before = run.energy();
  run.advance_to(4);
  if (energy != nullptr) *energy = run.energy() / before - 1;
  row.seconds += run.seconds();
  row.state_hash = run.state_hash();
  return {run.body().pose->center_of_mass, run.body().pose->orientation};
}

/// Compares with a run of the best method at a much smaller step. Its energy error shows its
/// accuracy.
void run_torque(Sheet& sheet) {
  Row fine{.metric = "relative change of the energy in the run compared with",
           .reference = 0,
           .tolerance = within(1e-10, "(omega dt)^4 with omega = 1.4 rad/s, dt = 1/512")};
  const Place exact =
      sampling_place_of(sheet, IntegratorId::runge_kutta_4, 1.0 / 512, fine, &fine.measured);
  sheet.add(fine);
  for (const IntegratorId integrator : kIntegrators) {
    const Real longest = theoretical_order(integrator) < 2 ? 1.0 / 256 : 1.0 / 16;
    const std::vector<Real> steps{longest, longest / 2, longest / 4};
    std::vector<Real> errors;
    Row row{.metric = std::string("order of convergence with a torque, ") + to_string(integrator),
            .reference = theoretical_order(integrator),
            .tolerance = within(0.2, "order of the method")};
    for (const Real step : steps) {
      const Place place = sampling_place_of(sheet, integrator, step, row);
      errors.push_back(std::hypot((place.center - exact.center).norm(),
                                  place.orientation.angularDistance(exact.orientation)));
    }
    row.measured = observed_order(steps, errors);
    sheet.add(row);
  }
}

}  // namespace

std::vector<Case> rigid_sampling_cases() {
  return {
      {"RIG-torque", "top with external forces and torques", "rigid", {"RIG-torque"}, run_torque},
      {"RIG-sampled", "inertia of sampled solids", "rigid", {"RIG-sampled"}, run_sampled}};
}

}  // namespace vat::validation
