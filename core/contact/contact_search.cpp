#include "core/contact/contact_search.h"

#include "core/support/check.h"

namespace vat {

void SortedParticles::build(const Model& model, const std::vector<Vec3>& positions,
                            std::span<const Index> particles, Real cell_size) {
  VAT_CHECK(cell_size > 0);
  places_.clear();
  for (const Index i : particles) places_.push_back(model.periodic.wrap(positions[i]));
  grid.build(places_, cell_size);
  const std::span<const Index> order = grid.order();
  particle.resize(order.size());
  body.resize(order.size());
  for (std::vector<Real>* column : {&x, &y, &z}) column->resize(order.size());
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const Vec3& p = places_[order[slot]];
    particle[slot] = particles[order[slot]];
    body[slot] = model.body[particle[slot]];
    x[slot] = p.x();
    y[slot] = p.y();
    z[slot] = p.z();
  }
}

}  // namespace vat
