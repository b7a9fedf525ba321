#include <cmath>
#include <numbers>

#include "tests/validation/cases.h"
#include "tests/validation/cases/liquid/liquid_rest.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

constexpr Real kSurfaceRadius = 0.05;

/// A drop with a radius of `layers` spacings. The support radius is 2.5 spacings with curvature in
/// three dimensions, otherwise 3.
Scene make_drop(SurfaceModel model, int dimensions, int layers) {
  Scene scene = load_scene("LIQ-8");
  scene.surface_model = model;
  scene.dimensions = dimensions;
  const Real spacing = kSurfaceRadius / layers;
  scene.bodies[0].spacing = spacing;
  scene.materials[0].liquid->support_radius =
      (dimensions == 3 && model == SurfaceModel::curvature ? 2.5 : 3) * spacing;
  return with_step(scene, acoustic_step(scene, 0.001));
}

/// Returns the radius of a ball or disc with the body's volume, relative to the reference.
Real radius_ratio(const Run& run) {
  const Scene& scene = run.simulation().scene();
  Real mass = 0;
  for (const Real m : run.body().masses) mass += m;
  const Real volume = mass / scene.materials[0].density;
  const Real radius = scene.dimensions == 3 ? std::cbrt(volume / (4 * std::numbers::pi / 3))
                                            : std::sqrt(volume / std::numbers::pi);
  return radius / kSurfaceRadius;
}

/// Returns the length along z minus that along x.
Real stretch(const Run& run) {
  const BodyView body = run.body();
  const Vec3 center = run.diagnostics().bodies[0].center_of_mass;
  Vec3 moments = Vec3::Zero();
  for (const Vec3& x : body.positions) moments += (x - center).cwiseAbs2();
  return std::log(moments.z() / moments.x());
}

/// Returns twice the mean time between `count` + 1 successive times at which the drop is round.
Real period(Run& run, int count) {
  std::vector<Real> zeros;
  const Real step = run.simulation().step_size();
  Real before = stretch(run);
  while (zeros.size() < static_cast<std::size_t>(count) + 1) {
    const Real begin = run.simulation().time();
    run.advance_to(begin + step);
    const Real after = stretch(run);
    if (before * after < 0) zeros.push_back(begin + step * before / (before - after));
    before = after;
  }
  return 2 * (zeros.back() - zeros.front()) / count;
}

/// Returns the pressure within half the radius, averaged over an oscillation.
Real inner_pressure(Run& run, Real duration) {
  Real sum = 0;
  std::size_t count = 0;
  run.observe_until(run.simulation().time() + duration, duration / 50, [&] {
    const BodyView body = run.body();
    const LiquidFields fields = run.simulation().liquid_fields(body.id).value();
    const Vec3 center = run.diagnostics().bodies[0].center_of_mass;
    for (std::size_t i = 0; i < body.positions.size(); ++i) {
      if ((body.positions[i] - center).norm() > kSurfaceRadius / 2) continue;
      sum += fields.pressure[i];
      ++count;
    }
  });
  return sum / static_cast<Real>(count);
}

/// The period is proportional to R^1.5, and R is known to half a spacing. Curvature and pressure
/// are distributed over a support radius h. The force corrects h/R to first order. Half of that
/// error remains if surfaces are not smooth.
void add_drop(Sheet& sheet, SurfaceModel model, int dimensions, int layers) {
  const bool is_plane = dimensions == 2;
  const std::string of = std::string(is_plane ? ", in the plane" : ", in space") + ", " +
                         to_string(model) + ", R/dx = " + std::to_string(layers);
  Scene scene = make_drop(model, dimensions, layers);
  const Real speed = 0.5 * std::sqrt(0.5 / (1000 * kSurfaceRadius)) / kSurfaceRadius;
  VectorField field;
  field.gradient = (speed * Vec3(is_plane ? -1 : -0.5, is_plane ? 0 : -0.5, 1)).asDiagonal();
  scene.bodies[0].velocity_field = field;
  Run run = sheet.start(scene);
  const Real exact =
      reference(is_plane ? "/liquid/LIQ-8/modes/2/T2D" : "/liquid/LIQ-8/modes/2/T3D") *
      std::pow(radius_ratio(run), 1.5);
  sheet.add("period [s]" + of, exact, period(run, sheet.quick() ? 2 : 3),
            within_relative(0.75 / layers, "R^1.5, with R to half a spacing"), run);
  if (!is_plane && sheet.quick()) return;
  const Real laplace =
      reference(is_plane ? "/liquid/LIQ-8/laplace_dp_2D" : "/liquid/LIQ-8/laplace_dp_3D") /
      radius_ratio(run);
  sheet.add("pressure inside [Pa]" + of, laplace, inner_pressure(run, 0.5),
            within_relative(1.5 / layers, "1/R, with R to half of the surface's thickness"), run);
}

void run_capillary_drop(Sheet& sheet) {
  for (const SurfaceModel model : {SurfaceModel::curvature, SurfaceModel::cohesion}) {
    add_drop(sheet, model, 2, 12);
    if (!sheet.quick()) add_drop(sheet, model, 2, 24);
    add_drop(sheet, model, 3, sheet.quick() ? 6 : 8);
    if (!sheet.quick()) add_drop(sheet, model, 3, 12);
  }
}

}  // namespace

std::vector<Case> liquid_surface_cases() {
  return {{"LIQ-8", "capillary drop", "liquid", {"LIQ-8"}, run_capillary_drop}};
}

}  // namespace vat::validation
