#include "core/device/solid/solid_tables.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/limits.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

// Structs of particles.cl and forces.cl.
struct SolidBody {
  double greatest_speed2;
  double omega2;
  double rate;
  std::int32_t material;
  std::int32_t touches_itself;
};
struct SolidLaw {
  double stiffness, damping, threshold, friction;
};
static_assert(sizeof(SpringEnd) == 32 && sizeof(VolumeCell) == 48 && sizeof(CellCorner) == 8);
static_assert(offsetof(SpringEnd, stiffness) == 8 && offsetof(SpringEnd, damping) == 16 &&
              offsetof(SpringEnd, rest_length) == 24);
static_assert(offsetof(VolumeCell, volume) == 32 && offsetof(VolumeCell, bulk_modulus) == 40);

std::vector<SolidBody> bodies_of(const Model& model, const GuardBounds& bounds) {
  std::vector<SolidBody> bodies;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    const Real speed = std::min(kMaxSpeed, bounds.travel[b] / model.scene.numerics.step);
    const Oscillation& own = model.damping.own[b];
    const bool touches_itself =
        body.kind == BodyKind::deformable && model.self_contacts[body.material].has_value();
    bodies.push_back({speed * speed, own.omega2, own.rate, static_cast<std::int32_t>(body.material),
                      touches_itself ? 1 : 0});
  }
  return bodies;
}

SolidLaw law_of(const ContactLaw& law) {
  return {law.stiffness, law.damping, law.threshold, law.friction};
}

std::vector<SolidLaw> laws_of(const Model& model) {
  std::vector<SolidLaw> laws;
  std::ranges::transform(model.contact_laws, std::back_inserter(laws), law_of);
  for (const std::optional<SpringConstants>& within : model.self_contacts) {
    const SpringConstants spring = within.value_or(SpringConstants{});
    laws.push_back({spring.stiffness, spring.damping, 0, 0});
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
/// The begins of the parts of particles in a table. In an empty table, all parts are empty.
Buffer begins_of(Program& program, const SharedArray<Index>& begins, std::size_t particles) {
  return begins.empty() ? table_of(program, std::vector<Index>(particles + 1, 0))
                        : table_of(program, begins);
}

}  // namespace

SolidTables::SolidTables(Program& program, const Model& model, const GuardBounds& bounds)
    : mass(table_of(program, model.mass)),
      mobility(table_of(program, model.inverse_mass)),
      radius(table_of(program, model.radius)),
      body_of(table_of(program, model.body)),
      bodies(table_of(program, bodies_of(model, bounds))),
      laws(table_of(program, laws_of(model))),
      exclusion_begin(begins_of(program, model.exclusion_begin, model.free_count)),
      exclusions(table_of(program, model.exclusions)),
      spring_begin(begins_of(program, model.spring_begin, model.free_count)),
      springs(table_of(program, model.spring_ends)),
      corner_begin(begins_of(program, model.cell_begin, model.free_count)),
      corners(table_of(program, model.cell_corners)),
      cells(table_of(program, model.cells)) {}

std::size_t SolidTables::bytes_for(const Model& model) {
  const std::size_t materials = model.scene.materials.size();
  return model.particle_count * (3 * sizeof(double) + sizeof(Index)) +
         model.bodies.size() * sizeof(SolidBody) + materials * (materials + 2) * sizeof(SolidLaw) +
         3 * (model.free_count + 1) * sizeof(Index) + model.exclusions.size() * sizeof(Index) +
         model.spring_ends.size() * sizeof(SpringEnd) +
         model.cell_corners.size() * sizeof(CellCorner) + model.cells.size() * sizeof(VolumeCell);
}

}  // namespace vat
