#include <algorithm>
#include <cmath>

#include "core/laws/cell_volume.h"
#include "core/sampling/sampling.h"
#include "core/solid/elongation_limit.h"
#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {
namespace {

/// Returns four times the time at which the pendulum first hangs vertically.
Real period_of(Run& run, Real step) {
  Real before = run.body().positions[1].x();
  while (before > 0 && run.simulation().time() < 2) {
    run.advance_to(run.simulation().time() + step);
    const Real now = run.body().positions[1].x();
    if (now <= 0) return 4 * (run.simulation().time() - step * now / (now - before));
    before = now;
  }
  return 0;
}

// The thread removes velocity inelastically: (w dt)^2 / 2 of the energy per step. With w^2 = 2 g
// cos / L, the loss is at most 2 g dt T / 4 / 2 of the energy until it hangs vertically, and half
// of this fraction of the speed.
void add_pendulum(Sheet& sheet) {
  const Real expected = reference("/deformable/DEF-4a/period/90");
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler}) {
    for (const Real step : {1e-3, 1e-4}) {
      Run run = sheet.start(with_method(load_scene("DEF-10"), integrator, step));
      const Real loss = 2 * 9.81 * step * expected / 4 / 2;
      sheet.add(std::string("period [s], ") + to_string(integrator) +
                    (step == 1e-3 ? ", step 1e-3" : ", step 1e-4"),
                expected, period_of(run, step), within_relative(loss, "first order: w^2 dt T / 8"),
                run);
      const Real length = (run.body().positions[1] - run.body().positions[0]).norm();
      const Real turn = 2 * 9.81 * step * step;
      sheet.add(std::string("length of the thread [m], ") + to_string(integrator) +
                    (step == 1e-3 ? ", step 1e-3" : ", step 1e-4"),
                1, length, within(turn + kElongationTolerance, "w^2 dt^2 / 2, and the tolerance"),
                run);
    }
  }
}

/// Expects the equilibrium shape of a soft cloth that hangs from its corners.
void add_cloth(Sheet& sheet) {
  for (const bool is_limited : {true, false}) {
    Scene scene = with_step(load_scene("DEF-3c"), 1e-4);
    for (SpringDescription& spring : scene.bodies[0].springs) spring.constants.stiffness /= 100;
    for (Material& material : scene.materials) {
      if (is_limited) material.elongation_limit = 0.1;
    }
    Run run = sheet.start(scene);
    const auto& start = std::get<ParticleShape>(scene.bodies[0].shape).positions;
    Real greatest = 0;
    run.observe_until(sheet.quick() ? 0.3 : 1, 1e-3, [&] {
      for (const SpringDescription& s : scene.bodies[0].springs) {
        const Real length = (run.body().positions[s.a] - run.body().positions[s.b]).norm();
        const Real rest = s.rest_length.value_or((start[s.a] - start[s.b]).norm());
        greatest = std::max(greatest, length / rest - 1);
      }
    });
    sheet.add(std::string("greatest strain of a falling cloth, ") +
                  (is_limited ? "limit 0.1" : "without limit"),
              is_limited ? 0.1 + 0.01 : 0.2, greatest,
              is_limited ? at_most("Provot: a tenth; a hundredth for turning springs")
                         : at_least("or the limit would show nothing"),
              run);
  }
}

/// One cell of particles, stretched by 1e-4.
void add_breathing(Sheet& sheet, int dimensions) {
  constexpr Real kStep = 1e-4;
  constexpr Real kModulus = 1e4;
  Scene scene = with_step(load_scene("DEF-11"), kStep);
  scene.dimensions = dimensions;
  scene.gravity.setZero();
  scene.vat.reset();
  scene.materials[0].springs.reset();
  scene.materials[0].bulk_modulus = kModulus;
  scene.bodies[0].shape = BoxShape{Vec3::Zero(), {0.2, dimensions == 3 ? 0.2 : 0.1, 0.2}};
  const Vec3 stretch(1e-4, dimensions == 3 ? 1e-4 : 0, 1e-4);
  scene.bodies[0].displacement_field = VectorField{{0, 0, 0.25}, stretch.asDiagonal(), {}};
  Run run = sheet.start(scene);
  const Real mass = run.body().masses[0];
  // With the lengths a s and s = 1 + e, the energy is K a^d (d e)^2 / 2. 2^d masses are at a
  // sqrt(d) / 2.
  const Real side = std::pow(0.1, dimensions - 2) * dimensions * dimensions * kModulus;
  const Real omega = std::sqrt(side / (std::pow(2, dimensions) * mass * dimensions / 4));
  std::vector<Real> samples;
  run.observe_until(20 / omega, kStep, [&] {
    samples.push_back((run.body().positions.back() - run.body().positions.front()).norm() -
                      0.1 * std::sqrt(dimensions));
  });
  sheet.add("frequency of a cell in " + std::to_string(dimensions) + " dimensions [rad/s]", omega,
            fitted_frequency(samples, kStep),
            within_relative(3e-4 + std::pow(omega * kStep, 2) / 24, "amplitude 1e-4, Verlet"), run);
}

/// Returns the volume of a body's cells, relative to the start.
Real kept_volume(const SampledBody& sample, const Run& run) {
  Real start = 0;
  Real now = 0;
  for (const SampledCell& cell : sample.cells) {
    start += cell.volume;
    now += cell_volume(run.body().positions, cell.corners, 3);
  }
  return now / start;
}

void add_block(Sheet& sheet) {
  const Scene scene = load_scene("DEF-11");
  const SampledBody sample = sample_bodies(scene)[0];
  for (const bool is_kept : {true, false}) {
    Scene one = scene;
    if (!is_kept) one.materials[0].bulk_modulus = 0;
    Run run = sheet.start(one);
    run.advance_to(sheet.quick() ? 2 : 5);
    const Real lost = 1 - kept_volume(sample, run);
    // The mean pressure under its weight is at most rho g h / 2.
    sheet.add(std::string("volume lost under its own weight, ") +
                  (is_kept ? "K = 10^5 Pa" : "springs alone"),
              is_kept ? 1000 * 9.81 * 0.5 / 2 / 1e5 : 0.1, lost,
              is_kept ? at_most("rho g h / 2 K") : at_least("or the cells would show nothing"),
              run);
    if (is_kept) {
      sheet.add("volume lost, K = 10^5 Pa", 0, lost, at_least("it is pressed"), run);
    }
  }
}

}  // namespace

std::vector<Case> kept_length_cases() {
  const std::string kind = "deformable";
  return {{"DEF-10",
           "springs with limited elongation",
           kind,
           {"DEF-10", "DEF-3c"},
           [](Sheet& sheet) {
             add_pendulum(sheet);
             add_cloth(sheet);
           }},
          {"DEF-11", "bodies with constant volume", kind, {"DEF-11"}, [](Sheet& sheet) {
             add_breathing(sheet, 3);
             add_breathing(sheet, 2);
             add_block(sheet);
           }}};
}

}  // namespace vat::validation
