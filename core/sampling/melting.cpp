#include "core/sampling/melting.h"

#include <numeric>

#include "core/support/check.h"

namespace vat {

BodyDescription melted(BodyDescription body, const std::string& into, Real mass) {
  body.kind = BodyKind::liquid;
  body.material = into;
  body.springs.clear();
  body.melting.reset();
  auto* particles = std::get_if<ParticleShape>(&body.shape);
  if (particles != nullptr) particles->fixed.clear();
  // By default, the mass of a liquid is that of its lattice at rest density.
  if (particles == nullptr || particles->masses.empty()) body.mass = mass;
  return body;
}

SampledBody melted(SampledBody sample) {
  sample.springs.clear();
  sample.cells.clear();
  sample.fixed.clear();
  return sample;
}

Scene with_all_melted(Scene scene, const std::vector<SampledBody>& samples) {
  VAT_CHECK(samples.size() == scene.bodies.size());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    BodyDescription& body = scene.bodies[b];
    if (!body.melting) continue;
    const std::vector<Real>& masses = samples[b].masses;
    body = melted(body, body.melting->into, std::accumulate(masses.begin(), masses.end(), Real{0}));
  }
  return scene;
}

}  // namespace vat
