#include "core/device/solid/solid_tables.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/device/contact/solid_geometry.h"
#include "core/limits.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

// Structs of particles.cl and contact_terms.cl.
struct SolidBody {
  double travel;
  double omega2;
  double rate;
  std::int32_t material;
  std::int32_t touches_itself;
};
struct SolidLaw {
  double stiffness, damping, threshold, friction, layer, damping_ratio;
};
static_assert(sizeof(SpringEnd) == 32 && sizeof(VolumeCell) == 48 && sizeof(CellCorner) == 8);
static_assert(offsetof(SpringEnd, stiffness) == 8 && offsetof(SpringEnd, damping) == 16 &&
              offsetof(SpringEnd, rest_length) == 24);
static_assert(offsetof(VolumeCell, volume) == 32 && offsetof(VolumeCell, bulk_modulus) == 40);

std::vector<SolidBody> bodies_of(const Model& model, const GuardBounds& bounds) {
  std::vector<SolidBody> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    const Oscillation& own = model.damping.own[b];
    const bool touches_itself =
        body.kind == BodyKind::deformable && model.self_contacts[body.material].has_value();
    bodies.push_back({bounds.travel[b], own.omega2, own.rate,
                      static_cast<std::int32_t>(body.material), touches_itself ? 1 : 0});
  }
  return bodies;
}

SolidLaw law_of(const ContactLaw& law) {
  return {law.stiffness, law.damping, law.threshold, law.friction, law.layer, law.damping_ratio};
}

std::vector<SolidLaw> laws_of(const Model& model) {
  std::vector<SolidLaw> laws;
  std::ranges::transform(model.contact_laws, std::back_inserter(laws), law_of);
  for (const std::optional<SpringConstants>& within : model.self_contacts) {
    const SpringConstants spring = within.value_or(SpringConstants{});
    laws.push_back({.stiffness = spring.stiffness, .damping = spring.damping});
  }
  std::ranges::transform(model.wall_laws, std::back_inserter(laws), law_of);
  return laws;
}

/// Returns a buffer with these values. An empty table has one unused entry.
template <class T>
Buffer table_of(Program& program, std::span<const T> values) {
  Buffer buffer(program, std::max<std::size_t>(1, values.size()) * sizeof(T));
  if (!values.empty()) program.write(buffer, values);
  return buffer;
}
template <class T>
Buffer table_of(Program& program, const std::vector<T>& values) {
  return table_of(program, std::span<const T>(values));
}
template <class T>
Buffer table_of(Program& program, const SharedArray<T>& values) {
  return table_of(program, std::span<const T>(values.data(), values.size()));
}
/// A table of the solid particles, from one of all particles.
template <class T>
Buffer solids_of(Program& program, const SolidRange& range, const std::vector<T>& values) {
  return table_of(program, std::span<const T>(values).subspan(range.first));
}
/// The begins of the parts of free particles in a table. In an empty table, all parts are empty.
/// Liquid particles have no parts.
Buffer begins_of(Program& program, const SolidRange& range, const SharedArray<Index>& begins) {
  if (begins.empty()) return table_of(program, std::vector<Index>(range.free + 1, 0));
  const std::span<const Index> all(begins.data(), begins.size());
  VAT_CHECK(all[range.first] == 0);
  return table_of(program, all.subspan(range.first));
}
/// A table of values that name particles: `shift` converts the indices of the model to those of
/// solids.
template <class T, class Shift>
Buffer shifted_table_of(Program& program, const SharedArray<T>& values, Shift&& shift) {
  std::vector<T> shifted(values.data(), values.data() + values.size());
  std::ranges::for_each(shifted, shift);
  return table_of(program, shifted);
}

}  // namespace

std::vector<SpringEnd> springs_on_device(const Model& model) {
  const auto first = static_cast<Index>(SolidRange(model).first);
  std::vector<SpringEnd> ends(model.spring_ends.begin(), model.spring_ends.end());
  for (SpringEnd& end : ends) end.other -= first;
  return ends;
}

SolidTables::SolidTables(Program& program, const Model& model, const GuardBounds& bounds) {
  const SolidRange range(model);
  const auto shift = [&](Index& particle) { particle -= static_cast<Index>(range.first); };
  mass = solids_of(program, range, model.mass);
  mobility = solids_of(program, range, model.inverse_mass);
  radius = solids_of(program, range, model.radius);
  body_of = solids_of(program, range, model.body);
  bodies = table_of(program, bodies_of(model, bounds));
  laws = table_of(program, laws_of(model));
  exclusion_begin = begins_of(program, range, model.exclusion_begin);
  exclusions = shifted_table_of(program, model.exclusions, shift);
  spring_begin = begins_of(program, range, model.spring_begin);
  springs = table_of(program, springs_on_device(model));
  corner_begin = begins_of(program, range, model.cell_begin);
  corners = table_of(program, model.cell_corners);
  cells = shifted_table_of(program, model.cells, [&](VolumeCell& cell) {
    // The corners of a cell in two dimensions are the first four.
    const std::size_t count = model.scene.dimensions == 2 ? 4 : 8;
    std::for_each_n(cell.corners.begin(), count, shift);
  });
}

std::size_t SolidTables::bytes_for(const Model& model) {
  const std::size_t materials = model.scene.materials.size();
  const SolidRange range(model);
  return range.count * (3 * sizeof(double) + sizeof(Index)) +
         model.bodies.size() * sizeof(SolidBody) + materials * (materials + 2) * sizeof(SolidLaw) +
         3 * (range.free + 1) * sizeof(Index) + model.exclusions.size() * sizeof(Index) +
         model.spring_ends.size() * sizeof(SpringEnd) +
         model.cell_corners.size() * sizeof(CellCorner) + model.cells.size() * sizeof(VolumeCell);
}

}  // namespace vat
