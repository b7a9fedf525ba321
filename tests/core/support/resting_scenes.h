#pragma once

#include <string>
#include <utility>

#include "tests/support/scenes.h"

/// Bodies that come to rest on a floor and sleep there.
namespace vat::test {

inline constexpr Real kRestRadius = 0.05;  ///< of particles [m]
inline constexpr Real kCrateRest = 0.15;   ///< height of a resting crate's centre [m]
inline constexpr Real kCrateEdge = 0.3;    ///< [m]

/// A floor with projection contacts, on which bodies come to rest to rounding.
inline Scene make_resting_scene(Real step = 1.0 / 240) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.numerics.tick = 4 * step;
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("wood")};
  scene.default_interface = {.friction = 0.5, .law = InterfaceLaw::projection};
  scene.vat = Vat{{-20, -20, 0}, {20, 20, 20}, false, {}, {}};
  scene.sleeping = Sleeping{1e-3, 0.2};
  return scene;
}

/// A cube of 27 particles and 2.7 kg around `center`.
inline BodyDescription make_crate(std::string name, const Vec3& center) {
  BodyDescription crate = make_body(std::move(name), BodyKind::rigid, "wood",
                                    make_particles(make_lattice(3, 3, 3, 0.1), 0.1), kRestRadius);
  crate.position = center;
  return crate;
}
inline BodyDescription make_crate(std::string name, Real x) {
  return make_crate(std::move(name), {x, 0, kCrateRest});
}

/// One particle of 0.5 kg.
inline BodyDescription make_marble(std::string name, const Vec3& center) {
  BodyDescription marble = make_body(std::move(name), BodyKind::rigid, "wood",
                                     make_particles({Vec3::Zero()}, 0.5), kRestRadius);
  marble.position = center;
  return marble;
}

/// A sleeping stack on which a marble falls after 1.06 s, and another crate that remains asleep.
inline Scene make_struck_stack() {
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("low", 0.0), make_marble("marble", {0.03, 0.02, 6}),
                  make_crate("high", {0.02, 0, kCrateRest + kCrateEdge}), make_crate("far", 5.0)};
  return scene;
}

inline constexpr Real kPoolSupport = 0.2;    ///< support radius of the liquid [m]
inline constexpr Real kPebbleRelease = 5;    ///< [s]
inline constexpr Real kPebbleSplash = 5.75;  ///< [s] the pebble is in the liquid

/// A pool of two blocks of particles that carries a cork. A pebble falls from 3 m above the floor
/// after both sleep.
inline Scene make_resting_pool(PressureSolver solver) {
  Scene scene = make_resting_scene(4e-3);
  scene.pressure_solver = solver;
  scene.numerics.tick = 0.012;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.materials.push_back(make_liquid("water", 1000, {100, 20, kPoolSupport}));
  scene.default_interface = {2000, 20};
  scene.interfaces = {{{"wood", "water"}, {.law = InterfaceLaw::sph}, {}}};
  scene.vat = Vat{{-0.4, -0.4, 0}, {0.4, 0.4, 4}, false, {}, {}};
  BodyDescription water = make_body("water", BodyKind::liquid, "water",
                                    make_particles(make_lattice(8, 8, 5, 0.1), 1), kRestRadius);
  water.position.z() = 0.25;
  scene.bodies = {water, make_marble("cork", {0, 0, 0.55}), make_marble("pebble", {0.1, 0.1, 3})};
  scene.bodies[2].release = kPebbleRelease;
  scene.sleeping = Sleeping{0.05, 0.3};  // half a percent of the speed of sound
  return scene;
}

inline bool is_asleep(const Simulation& simulation, const std::string& name) {
  return simulation.find_body(simulation.find_body(name).value())->is_asleep;
}

/// Advances tick by tick until the body sleeps or `time` is reached.
inline void advance_to_sleep(Simulation& simulation, const std::string& name, Real time) {
  while (simulation.time() < time && !is_asleep(simulation, name)) {
    simulation.advance(simulation.steps_per_tick());
  }
}

/// Returns the minimum distance between the particles of two bodies [m].
inline Real distance_of(const BodyView& a, const BodyView& b) {
  Real least = 1e9;
  for (const Vec3& p : a.positions) {
    for (const Vec3& q : b.positions) least = std::min(least, (p - q).norm());
  }
  return least;
}

}  // namespace vat::test
