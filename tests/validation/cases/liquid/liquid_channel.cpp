#include <cmath>
#include <numbers>

#include "core/kernels/smoothing_kernel.h"
#include "tests/validation/cases.h"
#include "tests/validation/order.h"
#include "tests/validation/reference.h"

namespace vat::validation {

namespace {

Real constant(const char* name) {
  return reference(std::string("/liquid/LIQ-7/") + name);
}

/// Returns the speed at the height z above the plate at rest, at time t after the other plate
/// started.
Real couette(Real z, Real t) {
  const Real length = constant("L");
  const Real top = constant("V0");
  Real speed = top * z / length;
  for (int n = 1; n < 200; ++n) {
    const Real k = n * std::numbers::pi / length;
    speed += 2 * top / (n * std::numbers::pi) * (n % 2 == 0 ? 1 : -1) * std::sin(k * z) *
             std::exp(-constant("nu") * k * k * t);
  }
  return speed;
}

/// Returns the speed at the height z between plates at rest, at time t after the force started.
Real poiseuille(Real z, Real t) {
  const Real length = constant("L");
  const Real nu = constant("nu");
  Real speed = constant("F") / (2 * nu) * z * (length - z);
  for (int n = 1; n < 200; n += 2) {
    const Real k = n * std::numbers::pi / length;
    speed -= 4 * constant("F") * length * length / (nu * std::pow(n * std::numbers::pi, 3)) *
             std::sin(k * z) * std::exp(-nu * k * k * t);
  }
  return speed;
}

using Profile = Real (*)(Real z, Real t);

/// Returns the relative L2 distance between the particles' speeds and the profile.
Real profile_error(const Run& run, Profile profile) {
  const BodyView body = run.body();
  Real error = 0;
  Real scale = 0;
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Real exact = profile(body.positions[i].z(), run.simulation().time());
    error += std::pow(body.velocities[i].x() - exact, 2);
    scale += exact * exact;
  }
  return std::sqrt(error / scale);
}

/// Returns the effective viscosity of a square lattice, relative to its material, for flows that
/// are almost uniform over a support of `reach` spacings. It is the summed second moment of the
/// Laplacian, divided by the square of the density sum.
Real lattice_viscosity(int reach) {
  Real density = 0;
  Real moment = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Real r = std::hypot(i, j);
      if (r >= reach) continue;
      density += 4 / (std::numbers::pi * std::pow(reach, 8)) * std::pow(reach * reach - r * r, 3);
      moment += 0.5 * i * i * 40 * (reach - r) / (std::numbers::pi * std::pow(reach, 5));
    }
  }
  return moment / (density * density);
}

/// Returns the same ratio for the central viscosity of the weakly compressible liquid. Its force
/// acts along the line between two particles: it is too weak along the lattice axes, and too strong
/// along the diagonals.
Real central_lattice_viscosity(int reach) {
  const SmoothingKernel kernel(KernelId::wendland_c2, reach, 2);
  Real sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Real r = std::hypot(i, j);
      if (r >= reach) continue;
      const Real softened = r * r + 0.01 * reach * reach / 4;
      sum -= 4 * i * i * j * j * kernel.slope_over_r(r) / softened;
    }
  }
  return sum / lattice_slope(kernel, reach, 1, 2);
}

Scene channel(PressureSolver solver, bool moving_plate, int layers, int reach) {
  const bool is_gas = solver == PressureSolver::gas;
  Scene scene = load_scene(is_gas ? "LIQ-7" : "LIQ-7-tait");
  if (!moving_plate) {
    scene.vat->walls[5].velocity.setZero();
    scene.gravity.x() = constant("F");
  }
  const Real height = constant("L");
  const Real spacing = height / layers;
  const Real width = 2 * reach * spacing;  // minimum period
  scene.periodic->max.x() = width;
  scene.vat->max.x() = width;
  scene.bodies[0].shape = BoxShape{{width / 2, 0, height / 2}, {width, 1, height}};
  scene.bodies[0].spacing = spacing;
  scene.materials[0].liquid->support_radius = reach * spacing;
  scene.materials[0].liquid->viscosity /=
      is_gas ? lattice_viscosity(reach) : central_lattice_viscosity(reach);
  return scene;
}

void check_flow(Sheet& sheet, PressureSolver solver, const char* name, bool moving_plate,
                Profile profile) {
  Run run = sheet.start(channel(solver, moving_plate, 20, 3));
  for (const char* time : {"0.0225", "0.045", "0.1125", "0.225", "1.0"}) {
    run.advance_to(std::stod(time));
    const std::string at = std::string("/liquid/LIQ-7/") + name + '/' + time + "/0.5";
    if (solver == PressureSolver::gas) {
      sheet.add(std::string("series for the speed in the middle [m/s], ") + name + ", t = " + time,
                reference(at), profile(constant("L") / 2, std::stod(time)),
                within_relative(1e-10, "the same series"), run);
    }
    sheet.add(std::string("relative L2 error of the speeds, 20 layers, ") + name + ", t = " + time,
              0, profile_error(run, profile), within(0.02, "published target"), run);
  }
}

void check_convergence(Sheet& sheet, PressureSolver solver, const char* name, bool moving_plate,
                       Profile profile) {
  Row row{
      .metric = std::string("order of convergence in the spacing, H/dx = 4, t = 0.1125, ") + name,
      .reference = 1,
      .tolerance = at_least("a slip of a part of a spacing at the walls, smoothing in the bulk")};
  std::vector<Real> spacings;
  std::vector<Real> errors;
  for (const int layers : {10, 20, 40}) {
    if (sheet.quick() && layers == 40) continue;
    Run run = sheet.start(
        with_step(channel(solver, moving_plate, layers, 4), 0.00025 * 100 / (layers * layers)));
    run.advance_to(0.1125);
    spacings.push_back(1.0 / layers);
    errors.push_back(profile_error(run, profile));
    row.seconds += run.seconds();
    row.state_hash = run.state_hash();
  }
  row.measured = observed_order(spacings, errors);
  sheet.add(row);
}

template <PressureSolver solver>
void run_channel(Sheet& sheet) {
  check_flow(sheet, solver, "couette", true, couette);
  check_flow(sheet, solver, "poiseuille", false, poiseuille);
  check_convergence(sheet, solver, "couette", true, couette);
  check_convergence(sheet, solver, "poiseuille", false, poiseuille);
}

// LIQ-19.

/// Nusselt's film with the nominal viscosity. The effective viscosity is between this value and
/// that of a lattice.
Real film_speed(const Scene& scene, Real z) {
  const Real nu = scene.materials[0].liquid->viscosity / scene.materials[0].density;
  const Real depth = scene.bodies[0].position.z() * 2;
  return scene.gravity.x() / nu * (depth * z - z * z / 2);
}

/// Returns the mean speed of the steady film, relative to theory.
Real mean_film_speed(const Run& run) {
  Real sum = 0;
  Real exact = 0;
  const BodyView body = run.body();
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    sum += body.velocities[i].x();
    exact += film_speed(run.simulation().scene(), body.positions[i].z());
  }
  return sum / exact;
}

void check_film(Sheet& sheet, PressureSolver solver) {
  const Real slack = 1 / central_lattice_viscosity(4) - 1;
  for (const int viscosity : {10, 100}) {
    Scene scene = load_scene("LIQ-19");
    scene.materials[0].liquid->viscosity = viscosity;
    if (solver == PressureSolver::incompressible) {
      scene.pressure_solver = solver;
      scene.numerics.integrator = IntegratorId::symplectic_euler;
    }
    Run run = sheet.start(scene);
    run.advance_to(0.4);
    const std::string of =
        std::string(", ") + to_string(solver) + ", " + std::to_string(viscosity) + " Pa s";
    const Real speed = mean_film_speed(run);
    sheet.add("mean speed / theoretical mean speed" + of, 1, speed,
              within_relative(slack, "the viscosity of a lattice at rest"), run);
    Run shorter = sheet.start(with_step(scene, scene.numerics.step / 4));
    shorter.advance_to(0.4);
    sheet.add("mean speed / mean speed with a quarter of the step" + of, 1,
              speed / mean_film_speed(shorter),
              within_relative(1e-3, "steady: only the solve's tolerance is left"), shorter);
  }
}

/// Uses steps of 8 and 80 times the limit of explicit viscosity.
void run_film(Sheet& sheet) {
  check_film(sheet, PressureSolver::tait);
  check_film(sheet, PressureSolver::incompressible);
}

}  // namespace

std::vector<Case> liquid_channel_cases() {
  return {{"LIQ-7", "channel flow", "liquid", {"LIQ-7"}, run_channel<PressureSolver::gas>},
          {"LIQ-7-tait",
           "channel flow of weakly compressible liquid",
           "liquid",
           {"LIQ-7-tait"},
           run_channel<PressureSolver::tait>},
          {"LIQ-19", "film of honey on a slope", "liquid", {"LIQ-19"}, run_film}};
}

}  // namespace vat::validation
