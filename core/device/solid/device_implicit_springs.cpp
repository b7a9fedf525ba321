#include "core/device/solid/device_implicit_springs.h"

#include <algorithm>
#include <span>

#include "core/device/common/kernel_values.h"
#include "core/solid/implicit_springs.h"
#include "core/solid/spring_system.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kColumns = 12;                // of implicit_springs.cl
constexpr std::size_t kSlope = 5 * sizeof(double);  // the struct SpringSlope of spring_system.cl

std::size_t implicit_count(const Model& model) {
  return model.free_count - model.implicit_begin;
}

std::size_t implicit_ends(const Model& model) {
  return std::max<std::size_t>(1,
                               model.spring_ends.size() - model.spring_begin[model.implicit_begin]);
}

std::size_t bytes_of_columns(const Model& model) {
  return kColumns * implicit_count(model) * 3 * sizeof(double);
}

}  // namespace

DeviceImplicitSprings::Bodies DeviceImplicitSprings::bodies_of(const Model& model) {
  Bodies all;
  for (const ModelBody& body : model.bodies) {
    const IndexRange& particles = body.particles;
    if (particles.begin < model.implicit_begin || particles.end > model.free_count) continue;
    Body& to = all.bodies.emplace_back();
    to.begin = number_of(particles.begin - model.implicit_begin);
    to.end = number_of(particles.end - model.implicit_begin);
    to.width = body.spring_width ? number_of(*body.spring_width) : -1;
    to.factor_cost = spring_factor_cost(model, body);
    to.factor_begin = static_cast<std::int64_t>(all.factor_size);
    if (body.spring_width) {
      all.factor_size += 3 * particles.size() * 3 * (std::size_t{*body.spring_width} + 1);
    }
    int fixed = 0;
    to.pivot = -1;
    for (Index i = particles.begin; i < particles.end; ++i) {
      to.free_mass += model.mass[i];
      if (model.inverse_mass[i] > 0) continue;
      to.pivot = number_of(i - model.implicit_begin);
      ++fixed;
    }
    if (fixed > 0) to.free_mass = 0;
    to.can_turn = fixed <= 1 ? 1 : 0;
    const auto ends = model.spring_ends.begin();
    to.is_damped = std::any_of(ends + model.spring_begin[particles.begin],
                               ends + model.spring_begin[particles.end],
                               [](const SpringEnd& spring) { return spring.damping > 0; });
  }
  return all;
}

DeviceImplicitSprings::DeviceImplicitSprings(Program& program, const Model& model)
    : program_(program),
      bodies_(bodies_of(model)),
      constants_{number_of(model.implicit_begin - SolidRange(model).first),
                 number_of(implicit_count(model)),
                 number_of(model.spring_begin[model.implicit_begin]),
                 number_of(SolidRange(model).first),
                 static_cast<std::int32_t>(model.scene.dimensions),
                 0,
                 0},
      table_(program, bodies_.bodies.size() * sizeof(Body)),
      stiffness_(program, implicit_count(model) * sizeof(double)),
      places_(program, implicit_count(model) * sizeof(Index)),
      slopes_(program, implicit_ends(model) * kSlope),
      factor_(program, std::max<std::size_t>(1, bodies_.factor_size) * sizeof(double)),
      columns_(program, bytes_of_columns(model)),
      counts_(program, bodies_.bodies.size() * sizeof(Counts)) {
  VAT_CHECK(has_implicit_springs(model) && model.implicit_places.size() == implicit_count(model));
  are_damped_ = std::ranges::any_of(bodies_.bodies, [](const Body& b) { return b.is_damped != 0; });
  std::vector<double> stiffness;
  for (Index i = model.implicit_begin; i < model.free_count; ++i) {
    double& sum = stiffness.emplace_back(0);
    for (Index e = model.spring_begin[i]; e < model.spring_begin[i + 1]; ++e) {
      sum += model.spring_ends[e].stiffness;
    }
  }
  program.write(table_, std::span<const Body>(bodies_.bodies));
  program.write(stiffness_, std::span<const double>(stiffness));
  program.write(places_,
                std::span<const Index>(model.implicit_places.data(), model.implicit_places.size()));
}

std::size_t DeviceImplicitSprings::bytes_for(const Model& model) {
  const Bodies all = bodies_of(model);
  return all.bodies.size() * (sizeof(Body) + sizeof(Counts)) +
         implicit_count(model) * (sizeof(double) + sizeof(Index)) + implicit_ends(model) * kSlope +
         std::max<std::size_t>(1, all.factor_size) * sizeof(double) + bytes_of_columns(model);
}

void DeviceImplicitSprings::move(Real dt, bool is_damping, const SolidTables& t,
                                 const opencl::Buffer& start, const opencl::Buffer& position,
                                 const opencl::Buffer& velocity) {
  Constants constants = constants_;
  constants.dt = dt;
  program_.run("move_implicit_springs", bodies_.bodies.size() * Program::kGroup, constants,
               std::int32_t{is_damping}, table_, t.spring_begin, t.springs, t.mass, t.mobility,
               stiffness_, places_, slopes_, factor_, columns_, start, position, velocity, counts_);
}

void DeviceImplicitSprings::drift(Real dt, const SolidTables& tables, const opencl::Buffer& start,
                                  const opencl::Buffer& position, const opencl::Buffer& velocity) {
  move(dt, false, tables, start, position, velocity);
}

void DeviceImplicitSprings::damp(Real dt, const SolidTables& tables, const opencl::Buffer& position,
                                 const opencl::Buffer& velocity) {
  if (are_damped_) move(dt, true, tables, position, position, velocity);
}

void DeviceImplicitSprings::clear_counts() {
  program_.fill_with_zeros(counts_, bodies_.bodies.size() * sizeof(Counts));
}

void DeviceImplicitSprings::count(AdvanceReport& report) {
  std::vector<Counts> counts(bodies_.bodies.size());
  program_.read(counts_, std::span(counts));
  for (std::size_t b = 0; b < counts.size(); ++b) {
    const Body& body = bodies_.bodies[b];
    report.iterations.springs += counts[b].passes;
    report.unsolved_drifts += counts[b].unsolved;
    report.particle_evaluations +=
        counts[b].passes * static_cast<std::uint64_t>(body.end - body.begin);
  }
}

}  // namespace vat
