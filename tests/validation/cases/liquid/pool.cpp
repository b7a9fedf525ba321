#include "tests/validation/cases/liquid/pool.h"

namespace vat::validation {

void clear_around_ball(Scene& scene, Real radius) {
  const Vec3 center = scene.bodies[1].position;
  Scene pool = scene;
  pool.bodies.resize(1);
  const Run run(pool);
  const BodyView lattice = run.body();
  ParticleShape shape;
  for (std::size_t i = 0; i < lattice.positions.size(); ++i) {
    if ((lattice.positions[i] - center).norm() < radius) continue;
    shape.positions.push_back(lattice.positions[i]);
    shape.masses.push_back(lattice.masses[i]);
  }
  scene.bodies[0].mass.reset();
  scene.bodies[0].shape = shape;
}

Real draft(const Run& run, Real radius, Real area) {
  const Diagnostics now = run.diagnostics();
  const Real volume = (now.bodies[0].mass + now.bodies[1].mass) / 1000;
  return (volume / area - now.bodies[1].center_of_mass.z() + radius) / (2 * radius);
}

}  // namespace vat::validation
