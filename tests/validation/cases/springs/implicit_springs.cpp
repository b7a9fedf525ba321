#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/solid/implicit_springs.h"
#include "tests/validation/cases.h"
#include "tests/validation/convergence.h"
#include "tests/validation/reference.h"

namespace vat::validation {
namespace {

Scene load_implicit(const std::string& name) {
  Scene scene = load_scene(name);
  for (Material& material : scene.materials) material.implicit_springs = true;
  return scene;
}

/// In one dimension the method is the implicit midpoint rule for any z = omega dt.
void add_oscillator_rows(Sheet& sheet) {
  constexpr Real kOmega = 10;
  constexpr Real kStretch = 1e-3;  // [m] small, so that a step of z = 1000 does not reverse it
  for (const Real z : {1.0, 10.0, 1000.0}) {
    const std::uint32_t steps = sheet.quick() ? 100 : 1000;
    Scene scene = with_step(load_implicit("DEF-1"), 0.01);
    auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
    shape.positions[1].x() = 1 + kStretch;
    const Real stiffer = std::pow(z / (kOmega * 0.01), 2);
    for (Real& mass : shape.masses) mass /= stiffer;
    Run run = sheet.start(scene);
    const Real energy = run.energy();
    run.advance_to(steps * 0.01);
    const std::string name = ", z = " + std::to_string(static_cast<int>(z));
    const Real phase = steps * 2 * std::atan(z / 2);
    sheet.add("x after " + std::to_string(steps) + " steps [m]" + name,
              1 + kStretch * std::cos(phase), run.body().positions[1].x(),
              within(2 * kStretch * steps * kSpringTolerance, "midpoint rule; 2 tolerances a step"),
              run);
    sheet.add("|E/E0 - 1|" + name, 4 * steps * kSpringTolerance,
              std::abs(run.energy() / energy - 1), at_most("no drift; 4 tolerances a step"), run);
  }
}

/// Compares errors of the beam's tip with those of position-based and block descent methods.
void add_beam_rows(Sheet& sheet) {
  const std::string beam = "/deformable/DEF-5/dynamic_release/tip_z/";
  const Scene scene = load_implicit("DEF-5");
  constexpr std::size_t kTipNode = 10 * 9 + 1 * 3 + 1;
  for (const char* method : {"xpbd_1_iteration", "vbd"}) {
    for (const Json& published :
         reference_at(std::string("/measured_yardsticks/cantilever_dynamic_DEF5/") + method)) {
      if (!published.at(0).is_number()) continue;  // more than one iteration
      const Real step = 0.5 / std::round(0.5 / published.at(0).get<Real>());
      Run run = sheet.start(with_step(scene, step));
      for (const std::size_t half : {1U, 2U}) {
        run.advance_to(half == 1 ? 0.5 : 1);
        const Real exact = reference(beam + (half == 1 ? "0.5" : "1.0"));
        sheet.add("error of tip z(" + std::string(half == 1 ? "0.5" : "1") + ") [m], step " +
                      published.at(0).dump() + ", beside " + method,
                  published.at(half).get<Real>(),
                  std::abs(run.body().positions[kTipNode].z() - exact),
                  at_most("the other method's"), run);
      }
    }
  }
}

void add_cube_rows(Sheet& sheet) {
  const Scene scene = load_implicit("DEF-6b");
  const auto corner_error = [](const Run& run) {
    return (run.body().positions[7] - reference_vector("/deformable/DEF-6b/corner_ppp/5")).norm();
  };
  add_order_row(sheet, scene, IntegratorId::velocity_verlet, halved(1.25e-3, 3), 5, 2,
                corner_error);
  constexpr Real kCoarseStep = 0.1;  // omega dt = 4
  Run run = sheet.start(with_step(scene, kCoarseStep));
  const BodyDiagnostics start = run.diagnostics().bodies[0];
  const Real energy = run.energy();
  run.advance_to(5);
  const BodyDiagnostics end = run.diagnostics().bodies[0];
  const Real steps = 5 / kCoarseStep;
  sheet.add("momentum drift [kg m/s], step 0.1", 1e-12,
            (end.linear_momentum - start.linear_momentum).norm(), at_most("round-off"), run);
  sheet.add("angular momentum drift [kg m^2/s], step 0.1", 1e-12,
            (end.angular_momentum - start.angular_momentum).norm(), at_most("round-off"), run);
  sheet.add("|E/E0 - 1|, step 0.1", 4 * steps * kSpringTolerance,
            std::abs(run.energy() / energy - 1), at_most("no drift; 4 tolerances a step"), run);
}

/// With damped springs of 10^9 N/m, the cube is rigid in steps of omega dt = 10^3.
void add_rigid_rows(Sheet& sheet) {
  Scene scene = with_step(load_implicit("DEF-6b"), 5e-3);
  for (SpringDescription& spring : scene.bodies[0].springs) spring.constants = {1e9, 1e5};
  Run run = sheet.start(scene);
  run.advance_to(1);
  // All moments of a cube are equal, so it rotates by |omega| t about its axis.
  const Vec3 omega(1, 2, 3);
  const Vec3 corner = Eigen::AngleAxisd(omega.norm(), omega.normalized()) * Vec3(0.5, 0.5, 0.5) +
                      Vec3(0.3, -0.2, 0.1);
  const Real turn = omega.norm() * 5e-3;
  sheet.add("distance of a corner to that of a rigid cube at t = 1 s [m]",
            std::sqrt(0.75) * omega.norm() * turn * turn / 12,
            (run.body().positions[7] - corner).norm(),
            at_most("midpoint rule: it turns by 2 tan(omega dt / 2)"), run);
}

}  // namespace

std::vector<Case> implicit_spring_cases() {
  return {{"DEF-7",
           "implicit springs with long steps",
           "deformable",
           {"DEF-1", "DEF-5", "DEF-6b"},
           [](Sheet& sheet) {
             add_oscillator_rows(sheet);
             add_beam_rows(sheet);
             add_cube_rows(sheet);
             add_rigid_rows(sheet);
           }}};
}

}  // namespace vat::validation
