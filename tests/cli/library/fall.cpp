// A wooden ball falls for half a second.

#include <core/simulation/simulation.h>

#include <iostream>

int main() {
  vat::Scene scene;
  scene.materials = {{.name = "wood", .density = 600}};
  vat::BodyDescription ball;
  ball.name = "ball";
  ball.kind = vat::BodyKind::rigid;
  ball.material = "wood";
  ball.shape = vat::SphereShape{.radius = 0.1};
  ball.spacing = 0.05;
  scene.bodies = {ball};

  vat::Result<vat::Simulation> created = vat::Simulation::create(scene);
  if (!created) {
    for (const vat::Error& error : created.errors()) std::cerr << error.message << '\n';
    return 1;
  }
  vat::Simulation& simulation = created.value();
  while (simulation.time() < 0.5) simulation.advance(simulation.steps_per_tick());
  const double height = simulation.diagnostics().bodies[0].center_of_mass.z();
  std::cout << "after " << simulation.time() << " s: " << height << " m\n";
}
