#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/stability/builders.h"
#include "tests/stability/maps/step_map.h"

namespace vat::stability {
namespace {

using Matrix = Eigen::MatrixXd;

/// Returns the modes of M x'' + C x' + K x = 0 with C = K 2 ratio / omega_max. Each has another
/// damping.
std::vector<Oscillation> modes_of(const Matrix& stiffness, const Eigen::VectorXd& masses,
                                  Real ratio) {
  const Eigen::VectorXd root = masses.cwiseSqrt().cwiseInverse();
  const Matrix scaled = root.asDiagonal() * stiffness * root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(scaled, Eigen::EigenvaluesOnly);
  const Real greatest = solver.eigenvalues().maxCoeff();
  std::vector<Oscillation> modes;
  for (const Real omega2 : solver.eigenvalues()) {
    if (omega2 < 1e-9 * greatest) continue;  // free flight
    modes.push_back({omega2, 2 * ratio * omega2 / std::sqrt(greatest)});
  }
  return modes;
}

Real damping_of(const LinearCase& linear) {
  Real greatest = 0;
  for (const Oscillation& mode : linear.modes) greatest = std::max(greatest, mode.omega2);
  return 2 * linear.damping_ratio / std::sqrt(greatest) * linear.stiffness;
}

/// Moves every free particle by up to the displacement, along each axis in turn.
void displace(std::vector<Vec3>& points, const std::vector<Index>& fixed, Real displacement,
              bool in_space) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::ranges::count(fixed, static_cast<Index>(i)) > 0) continue;
    const auto turn = [&](std::size_t period) { return i % period == 0 ? 1.0 : -0.7; };
    points[i] += displacement * Vec3(turn(2), in_space ? turn(3) : 0, in_space ? turn(5) : 0);
  }
}

/// Returns a body of springs at rest length in free space, and its modes.
LinearCase make_springs(std::string name, const std::vector<Vec3>& points, std::vector<Real> masses,
                        std::vector<Index> fixed, std::vector<SpringDescription> springs,
                        Real ratio) {
  LinearCase linear;
  linear.body = std::move(name);
  linear.stiffness = springs[0].constants.stiffness;
  linear.damping_ratio = ratio;
  linear.rest = points;
  linear.mass_ratio = std::ranges::max(masses) / std::ranges::min(masses);
  const bool in_space = springs.size() > points.size();
  const auto size = static_cast<Eigen::Index>(3 * points.size());
  Matrix stiffness = Matrix::Zero(size, size);
  for (SpringDescription& spring : springs) {
    const Vec3 x = points[spring.a] - points[spring.b];
    spring.rest_length = x.norm();
    const Mat3 along = spring.constants.stiffness * x * x.transpose() / x.squaredNorm();
    const Eigen::Index a = 3 * static_cast<Eigen::Index>(spring.a);
    const Eigen::Index b = 3 * static_cast<Eigen::Index>(spring.b);
    stiffness.block<3, 3>(a, a) += along;
    stiffness.block<3, 3>(b, b) += along;
    stiffness.block<3, 3>(a, b) -= along;
    stiffness.block<3, 3>(b, a) -= along;
  }
  Eigen::VectorXd inertia(size);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_fixed = std::ranges::count(fixed, static_cast<Index>(i)) > 0;
    inertia.segment<3>(3 * static_cast<Eigen::Index>(i)).setConstant(is_fixed ? 1e30 : masses[i]);
  }
  linear.modes = modes_of(stiffness, inertia, ratio);
  const Real damping = damping_of(linear);
  for (SpringDescription& spring : springs) spring.constants.damping = damping;

  linear.scene = make_scene();
  linear.scene.gravity = Vec3::Zero();
  linear.scene.materials[2].self_contact.reset();
  linear.displacement = 1e-7;
  ParticleShape shape = test::make_particles(points, 1);
  shape.masses = std::move(masses);
  shape.fixed = fixed;
  displace(shape.positions, fixed, linear.displacement, in_space);
  linear.scene.bodies = {
      test::make_body("body", BodyKind::deformable, "rubber", std::move(shape), kSpacing / 2)};
  linear.scene.bodies[0].springs = std::move(springs);
  return linear;
}

LinearCase make_oscillator(Real stiffness, Real ratio) {
  return make_springs("oscillator", {{0, 0, 0}, {1, 0, 0}}, {1, 1}, {0},
                      {{0, 1, {stiffness, 0}, {}}}, ratio);
}

LinearCase make_pair(Real stiffness, Real mass_ratio, Real ratio) {
  return make_springs("pair", {{0, 0, 0}, {1, 0, 0}}, {1, mass_ratio}, {},
                      {{0, 1, {stiffness, 0}, {}}}, ratio);
}

LinearCase make_linear_chain(Real stiffness, Real mass_ratio, Real ratio) {
  std::vector<Vec3> points;
  std::vector<Real> masses;
  std::vector<SpringDescription> springs;
  for (Index n = 0; n < 18; ++n) {
    points.push_back({0.1 * n, 0, 0});
    masses.push_back(n % 2 == 0 ? 0.1 : 0.1 * mass_ratio);
    if (n > 0) springs.push_back({n - 1, n, {stiffness, 0}, {}});
  }
  return make_springs("chain", points, masses, {0, 17}, springs, ratio);
}

LinearCase make_lattice(Real stiffness, Real mass_ratio, Real ratio) {
  const std::vector<Vec3> points = test::make_lattice(4, 3, 3, 0.1);
  std::vector<Real> masses(points.size(), 0.1);
  for (std::size_t i = 0; i < masses.size(); i += 2) masses[i] *= mass_ratio;
  return make_springs("lattice", points, masses, {}, test::join_near(points, 0.15, {stiffness, 0}),
                      ratio);
}

/// Returns balls at rest on the floor, each a rigid particle. They stay in contact if they move by
/// less than their overlap.
LinearCase make_balls(std::string name, const std::vector<Real>& masses, Real stiffness,
                      Real ratio) {
  LinearCase linear;
  linear.body = std::move(name);
  linear.stiffness = stiffness;
  linear.damping_ratio = ratio;
  linear.mass_ratio = std::ranges::max(masses) / std::ranges::min(masses);
  const auto count = static_cast<Eigen::Index>(masses.size());
  Matrix matrix = Matrix::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    matrix(i, i) = i + 1 < count ? 2 * stiffness : stiffness;
    if (i > 0) matrix(i, i - 1) = matrix(i - 1, i) = -stiffness;
  }
  linear.modes = modes_of(matrix, Eigen::VectorXd::Map(masses.data(), count), ratio);

  Scene& scene = linear.scene;
  scene = make_tank();
  Real total = 0;
  for (const Real mass : masses) total += mass;
  // The weight of all balls presses the first ball in by a tenth of its radius.
  const Real radius = 0.05;
  const Real gravity = 0.1 * radius * stiffness / total;
  scene.gravity = {0, 0, -gravity};
  scene.default_interface = {stiffness, damping_of(linear)};
  for (auto& interface : scene.interfaces) interface.constants = scene.default_interface;
  linear.displacement = 1e-8;
  Real height = 0;
  Real load = total;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    height += (i == 0 ? radius : 2 * radius) - load * gravity / stiffness;
    load -= masses[i];
    const Vec3 rest(0.5, 0.5, height);
    linear.rest.push_back(rest);
    scene.bodies.push_back(make_particle("ball " + std::to_string(i), BodyKind::rigid,
                                         rest + linear.displacement * Vec3(0, 0, i == 0 ? 1 : -0.7),
                                         masses[i], radius));
  }
  return linear;
}

}  // namespace

std::vector<LinearCase> implicit_cases(bool quick) {
  std::vector<LinearCase> cases;
  for (const Real stiffness :
       quick ? std::vector<Real>{1e8} : std::vector<Real>{1, 1e4, 1e8, 1e12}) {
    for (const Real ratio : {0.0, 0.05, 1.0}) {
      cases.push_back(make_oscillator(stiffness, ratio));
      for (const Real mass_ratio :
           quick ? std::vector<Real>{100} : std::vector<Real>{1, 100, 1e4}) {
        cases.push_back(make_pair(stiffness, mass_ratio, ratio));
        cases.push_back(make_linear_chain(stiffness, mass_ratio, ratio));
        cases.push_back(make_lattice(stiffness, mass_ratio, ratio));
      }
    }
  }
  for (LinearCase& linear : cases) {
    linear.body += ", implicit springs";
    linear.steps = 500;
    for (Material& material : linear.scene.materials) material.implicit_springs = true;
  }
  return cases;
}

std::vector<LinearCase> linear_cases(bool quick) {
  std::vector<LinearCase> cases;
  for (const Real stiffness : quick ? std::vector<Real>{1e4} : std::vector<Real>{1e4, 1e8}) {
    const Real ball = stiffness / 1e4;  // [kg] heavier, where gravity would exceed its range
    for (const Real ratio : {0.0, 0.05, 0.1, 0.5, 1.0}) {
      cases.push_back(make_oscillator(stiffness, ratio));
      cases.push_back(make_balls("ball on the floor", {ball}, stiffness, ratio));
      for (const Real mass_ratio :
           quick ? std::vector<Real>{1, 100} : std::vector<Real>{1, 10, 100, 1e3, 1e4}) {
        cases.push_back(make_pair(stiffness, mass_ratio, ratio));
        cases.push_back(make_linear_chain(stiffness, mass_ratio, ratio));
        if (!quick || mass_ratio > 1) cases.push_back(make_lattice(stiffness, mass_ratio, ratio));
        cases.push_back(
            make_balls("two balls on the floor", {ball, ball * mass_ratio}, stiffness, ratio));
      }
    }
  }
  for (LinearCase& liquid : liquid_cases(quick)) cases.push_back(std::move(liquid));
  return cases;
}

}  // namespace vat::stability
