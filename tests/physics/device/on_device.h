#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/device_use.h"
#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

/// Simulations on an OpenCL device. The test machine computes them by PoCL.
namespace vat::test {

/// A scene of a table, as changes of a common scene.
struct SceneCase {
  const char* name;
  std::function<void(Scene&)> edit;
};

inline std::unique_ptr<StepEngine> make_device(const char* text = "opencl") {
  Result<std::unique_ptr<StepEngine>> engine = make_engine(parse_device(text).value());
  if (!engine) throw std::runtime_error(engine.errors().front().message);
  return std::move(engine).value();
}

/// Creates a simulation on a device. Throws if the device lacks a feature of the scene.
inline Simulation make_on_device(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  if (const Status set = simulation.set_engine(make_device()); !set) {
    throw std::runtime_error(set.errors().front().path);
  }
  return simulation;
}

/// Returns the greatest difference of positions after the same time [m].
inline Real difference(const Simulation& a, const Simulation& b) {
  Real greatest = 0;
  for (std::size_t body = 0; body < a.bodies().size(); ++body) {
    const BodyView one = a.bodies()[body];
    const BodyView other = b.bodies()[body];
    for (std::size_t i = 0; i < one.positions.size(); ++i) {
      greatest = std::max(greatest, (one.positions[i] - other.positions[i]).norm());
    }
  }
  return greatest;
}

/// Returns the relative rounding error of a state after `steps` steps. The order of sums differs,
/// so that each step adds about ten units in the last place. Contacts double the error a few times.
inline Real rounding_after(std::uint32_t steps) {
  constexpr Real kGrowth = 1000;
  return kGrowth * 10 * static_cast<Real>(steps) * 0x1p-53;
}

/// Expects that the device takes all steps, with the motion and the work of the CPU.
inline void expect_motion_of_cpu(const Scene& scene, std::uint32_t steps) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(steps);
  const AdvanceReport expected = cpu.advance(steps);
  EXPECT_EQ(report.device_steps, steps) << expected.wall_stops << " stops of the CPU";
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_EQ(report.force_evaluations, expected.force_evaluations);
  EXPECT_EQ(report.wall_stops, expected.wall_stops);
  EXPECT_EQ(report.iterations.damping, expected.iterations.damping);
  EXPECT_EQ(report.iterations.contacts, expected.iterations.contacts);
  EXPECT_EQ(report.iterations.springs, expected.iterations.springs);
  EXPECT_EQ(report.iterations.elongation, expected.iterations.elongation);
  EXPECT_EQ(expected.undone_steps, 0U);
  EXPECT_LT(difference(device, cpu), rounding_after(steps));
}

/// The integrators without a closing kick.
inline constexpr IntegratorId kOtherIntegrators[] = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::heun,
    IntegratorId::runge_kutta_4};

/// Expects the motion of the CPU with each of these integrators, which differ.
inline void expect_motion_with_other_integrators(Scene scene, std::uint32_t steps) {
  std::vector<Simulation> ends;
  for (const IntegratorId integrator : kOtherIntegrators) {
    SCOPED_TRACE(static_cast<int>(integrator));
    scene.numerics.integrator = integrator;
    expect_motion_of_cpu(scene, steps);
    ends.push_back(make_simulation(scene));
    ends.back().advance(steps);
    for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
      EXPECT_GT(difference(ends[n], ends.back()), 10 * rounding_after(steps));
    }
  }
}

/// Returns an emitter in the free part of a vat of 0.3 x 0.12 x 0.4 m.
inline Emitter make_tap_into(const std::string& body) {
  Emitter tap;
  tap.name = "tap";
  tap.body = body;
  tap.position = {0.22, 0.06, 0.1};
  tap.size = {{0.08, 0.08}};
  tap.speed = 1;
  tap.most_particles = 1000;
  return tap;
}

/// Returns a fixed rigid body of the material "stone".
inline BodyDescription make_fixed(const std::string& name, const Shape& shape, Real spacing) {
  BodyDescription body{name, BodyKind::rigid, "stone", shape, spacing};
  body.fixed = true;
  return body;
}

/// Adds a ball and a step beside the box of liquid, near a wall and the floor.
inline void add_fixed_bodies(Scene& scene) {
  scene.materials.push_back(make_material("stone", 2000));
  scene.bodies.push_back(make_fixed("ball", SphereShape{{0.19, 0.03, 0.03}, 0.025}, 0.01));
  scene.bodies.push_back(make_fixed("step", BoxShape{{0.22, 0.09, 0.03}, {0.1, 0.06, 0.06}}, 0.02));
}

/// Sets two dimensions in a scene with a vat and a box of liquid.
inline void set_plane_of_liquid(Scene& scene) {
  scene.dimensions = 2;
  std::get<BoxShape>(scene.bodies[0].shape).center.y() = 0;
  scene.vat->min.y() = -1;
  scene.vat->max.y() = 1;
}

/// Changes of a scene with a vat and a box of liquid as its first body, for any solver.
inline const SceneCase kCommonScenes[] = {
    {"unchanged", [](Scene&) {}},
    {"in a corner with a lid",
     [](Scene& scene) {
       scene.vat->lid = true;
       scene.vat->max = {0.3, 0.12, 0.25};
     }},
    {"sliding vat",
     [](Scene& scene) {
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0.5).normalized(), 0.1, 0.2};
     }},
    {"two dimensions", set_plane_of_liquid},
    {"settling",
     [](Scene& scene) {
       scene.settling = Settling{20, 0.015};
     }},
    {"fixed bodies in a sliding vat",
     [](Scene& scene) {
       add_fixed_bodies(scene);
       scene.vat->motion = SlideMotion{Vec3(1, 0, 0), 0.1, 0.2};
     }},
    {"two bodies",
     [](Scene& scene) {
       scene.bodies.push_back(scene.bodies[0]);
       scene.bodies[1].name = "drop";
       scene.bodies[1].shape = SphereShape{{0.22, 0.06, 0.2}, 0.04};
       scene.bodies[1].velocity = {-1, 0, -2};
     }},
};

/// Makes three walls of the vat no-slip walls. The floor moves like a belt.
inline void set_no_slip(Scene& scene) {
  for (const std::size_t wall : {0U, 2U, 4U}) scene.vat->walls[wall].no_slip = true;
  scene.vat->walls[4].velocity = {1, 0, 0};
}

/// Expects that the device differs from double precision by at most `ratio` times as much as the
/// CPU with single precision.
inline void expect_accuracy_of_cpu(const Scene& common, std::span<const SceneCase> cases,
                                   std::uint32_t steps, Real ratio = 3) {
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = common;
    one.edit(scene);
    Simulation device = make_on_device(scene);
    Simulation single = make_simulation(scene);
    scene.pair_precision = PairPrecision::double_precision;
    Simulation exact = make_simulation(scene);
    const AdvanceReport report = device.advance(steps);
    const AdvanceReport expected = single.advance(steps);
    exact.advance(steps);
    EXPECT_EQ(report.device_steps, steps) << expected.undone_steps << " steps of the CPU fail";
    EXPECT_EQ(report.steps, expected.steps);
    EXPECT_EQ(report.force_evaluations, expected.force_evaluations);
    EXPECT_EQ(report.wall_stops, expected.wall_stops);
    EXPECT_EQ(report.iterations.damping, expected.iterations.damping);
    EXPECT_LT(difference(device, exact), ratio * difference(single, exact));
    EXPECT_GT(difference(device, make_simulation(scene)), 1e-4) << "it moves";
  }
}

/// Expects this accuracy with each integrator without a closing kick.
inline void expect_accuracy_with_other_integrators(Scene common, std::span<const SceneCase> cases,
                                                   std::uint32_t steps) {
  for (const IntegratorId integrator : kOtherIntegrators) {
    SCOPED_TRACE(static_cast<int>(integrator));
    common.numerics.integrator = integrator;
    expect_accuracy_of_cpu(common, cases, steps);
  }
}

/// Expects that the device takes the adaptive steps of the CPU, because their limits differ by
/// rounding only. The motion must limit a step to less than a quarter of the nominal step.
inline void expect_adaptive_steps_of_cpu(const Scene& scene, int ticks) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  Real least = scene.numerics.step;
  for (int tick = 0; tick < ticks; ++tick) {
    const AdvanceReport report = device.advance(1);
    const AdvanceReport expected = cpu.advance(1);
    EXPECT_EQ(report.device_steps, 1U);
    EXPECT_EQ(report.steps, expected.steps) << tick;
    EXPECT_EQ(report.force_evaluations, expected.force_evaluations) << tick;
    EXPECT_NEAR(report.least_step, expected.least_step, 1e-12) << tick;
    EXPECT_NEAR(report.greatest_step, expected.greatest_step, 1e-12) << tick;
    least = std::min(least, report.least_step);
  }
  EXPECT_LT(least, scene.numerics.step / 4) << "the motion limits steps";
}

/// Expects that the CPU takes the steps of a scene, because one of them fails, with the same
/// results as without a device.
inline void expect_steps_of_cpu(const Scene& scene, std::uint32_t steps) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(steps);
  const AdvanceReport expected = cpu.advance(steps);
  EXPECT_EQ(report.device_steps, 0U);
  EXPECT_GT(report.undone_steps, 0U);
  EXPECT_EQ(report.undone_steps, expected.undone_steps);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_EQ(report.wall_stops, expected.wall_stops);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
}

/// Expects equal bits after ten steps in one call and in calls of 3 and 7 steps, `rounds` times,
/// and after a snapshot is restored.
inline void expect_same_bits_in_any_portions(const Scene& scene, std::uint32_t rounds) {
  Simulation one = make_on_device(scene);
  Simulation other = make_on_device(scene);
  one.advance(10 * rounds);
  for (std::uint32_t n = 0; n < 2 * rounds; ++n) other.advance(n % 2 == 0 ? 3 : 7);
  EXPECT_EQ(one.state_hash(), other.state_hash());
  const Snapshot middle = one.snapshot();
  one.advance(20);
  const std::uint64_t end = one.state_hash();
  one.restore(middle);
  EXPECT_EQ(one.advance(20).device_steps, 20U);
  EXPECT_EQ(one.state_hash(), end);
}

/// Expects that the device solves for damping in at least `least` iterations, and that its motion
/// differs from that of the CPU by at most the tolerance of these solves.
inline void expect_damping_of_cpu(const Scene& scene, std::uint32_t steps, std::uint64_t least) {
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(steps);
  const AdvanceReport expected = cpu.advance(steps);
  EXPECT_EQ(report.device_steps, steps);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_GE(report.iterations.damping, least);
  EXPECT_GE(expected.iterations.damping, least);
  const Real moved = difference(device, make_simulation(scene));
  EXPECT_LT(difference(device, cpu), kDampingTolerance * moved);
}

/// Expects that the device continues a state of the CPU, and the reverse, with this tolerance of
/// positions after `steps` steps [m].
inline void expect_continuation(const Scene& scene, std::uint32_t steps, Real tolerance) {
  Simulation cpu = make_simulation(scene);
  cpu.advance(steps);
  Simulation device = Simulation::from(cpu.snapshot());
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
  ASSERT_TRUE(device.set_engine(make_device()).ok());
  EXPECT_EQ(device.advance(steps).device_steps, steps);
  cpu.advance(steps);
  EXPECT_LT(difference(device, cpu), tolerance);
  Simulation back = Simulation::from(device.snapshot());
  EXPECT_EQ(back.state_hash(), device.state_hash());
  EXPECT_EQ(back.advance(steps).device_steps, 0U);
  device.advance(steps);
  EXPECT_LT(difference(back, device), tolerance);
}

/// Expects that the device has its state before a call if a step of the call fails. The first
/// `good` steps succeed, and one of the next `bad` steps fails.
inline void expect_restored_state(const Scene& scene, std::uint32_t good, std::uint32_t bad) {
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(good).device_steps, good);
  Simulation twin = make_on_device(scene);
  twin.advance(good);
  Simulation cpu = Simulation::from(twin.snapshot());
  const AdvanceReport report = device.advance(bad);
  const AdvanceReport expected = cpu.advance(bad);
  EXPECT_EQ(report.device_steps, 0U);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_EQ(report.least_step, expected.least_step);
  EXPECT_EQ(device.state_hash(), cpu.state_hash());
}

/// Expects that the device refuses each scene. The name of a case is the path of the error.
inline void expect_refusals(const Scene& common, std::span<const SceneCase> cases) {
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = common;
    one.edit(scene);
    Simulation simulation = make_simulation(scene);
    const Status set = simulation.set_engine(make_device());
    ASSERT_FALSE(set.ok());
    EXPECT_TRUE(std::ranges::any_of(set.errors(), [&](const Error& error) {
      return error.path == one.name && error.code == "not_on_device";
    })) << set.errors().front().path;
  }
}

}  // namespace vat::test
