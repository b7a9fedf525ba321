#include "tests/stability/accuracy_sweep.h"

#include <cmath>

#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace vat::stability {
namespace {

constexpr Real kSweepTick = 0.02;     // [s]
constexpr Real kSweepEnd = 10;        // [s]
constexpr Real kSweepFrequency = 10;  // [rad/s]
constexpr Real kSweepGravity = 9.81;  // [m/s^2]
constexpr Real kSweepHeight = 4;      // of the fixed end of the oscillator [m]
constexpr Real kSweepStart = 1.2;     // length at the start, with a rest length of 1 [m]
constexpr Real kSweepMiddle = 1 + kSweepGravity / (kSweepFrequency * kSweepFrequency);  // [m]

/// A mass that hangs from a spring.
Scene make_oscillator() {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -kSweepGravity};
  scene.materials = {test::make_material("steel")};
  BodyDescription body =
      test::make_body("oscillator", BodyKind::deformable, "steel",
                      test::make_particles({Vec3::Zero(), {0, 0, -kSweepStart}}, 1), 0.01);
  body.position = {0, 0, kSweepHeight};
  body.springs = {{0, 1, {kSweepFrequency * kSweepFrequency, 0}, 1.0}};
  std::get<ParticleShape>(body.shape).fixed = {0};
  scene.bodies = {body};
  return scene;
}

void add_floor(Scene& scene, const InterfaceConstants& law) {
  scene.vat = Vat{{-20, -20, 0}, {20, 20, 20}, false, {}, {}};
  scene.default_interface = law;
}

void add_ball(Scene& scene) {
  BodyDescription ball = test::make_body("ball", BodyKind::rigid, "steel",
                                         test::make_particles({Vec3::Zero()}, 1), 0.1);
  ball.position = {3, 0, 1};
  scene.bodies.push_back(ball);
}

void add_block(Scene& scene) {
  BodyDescription block =
      test::make_body("block", BodyKind::rigid, "steel",
                      test::make_particles(test::make_lattice(4, 4, 2, 0.1), 0.5), 0.05);
  block.position = {3, 0, 0.1};
  block.velocity = {5, 0, 0};
  scene.bodies.push_back(block);
}

void add_rope(Scene& scene) {
  scene.materials.push_back(test::make_material("rope"));
  scene.materials.back().implicit_springs = true;
  ParticleShape shape = test::make_particles(test::make_lattice(20, 1, 1, 0.1), 0.1);
  shape.fixed = {0};
  BodyDescription rope = test::make_body("rope", BodyKind::deformable, "rope", shape, 0.02);
  rope.springs = test::join_near(shape.positions, 0.11, {1e6, 1e2});
  rope.position = {3, 0, kSweepHeight};
  scene.bodies.push_back(rope);
}

}  // namespace

Scene accuracy_scene(const std::string& name, Real accuracy) {
  Scene scene = make_oscillator();
  if (name == "bouncing-ball") {
    add_floor(scene, {.stiffness = 1e4, .damping = 10});
    add_ball(scene);
  } else if (name == "projected-contacts") {
    add_floor(scene, {.friction = 0.5, .law = InterfaceLaw::projection});
    add_block(scene);
  } else if (name == "implicit-springs") {
    add_rope(scene);
  }
  scene.numerics.accuracy = accuracy;
  scene.numerics.tick = kSweepTick;
  return scene;
}

AccuracyPoint measure_accuracy(const std::string& name, Real accuracy) {
  Simulation simulation = test::make_simulation(accuracy_scene(name, accuracy));
  AccuracyPoint point{.scene = name, .accuracy = accuracy};
  for (int tick = 0; tick < std::lround(kSweepEnd / kSweepTick); ++tick) {
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    point.failed |= report.failed || report.undone_steps > 0;
    point.steps += report.steps;
    point.evaluations += report.force_evaluations;
    point.iterations += report.iterations.contacts + report.iterations.springs;
  }
  const Real length = kSweepHeight - simulation.bodies()[0].positions[1].z();
  const Real amplitude = kSweepStart - kSweepMiddle;
  const Real exact = kSweepMiddle + amplitude * std::cos(kSweepFrequency * kSweepEnd);
  point.error = std::abs(length - exact) / amplitude;
  return point;
}

std::vector<Real> all_accuracies() {
  return {1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1};
}

}  // namespace vat::stability
