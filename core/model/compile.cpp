#include "core/model/compile.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/laws/surface_tension.h"
#include "core/laws/vat_motion.h"
#include "core/model/compile_parts.h"
#include "core/numerics/step_limits.h"
#include "core/sampling/mass_properties.h"
#include "core/sampling/volumes.h"
#include "core/support/check.h"

namespace vat {

std::uint64_t first_step_from(Real time, Real step) {
  constexpr Real kRounding = 1e-6;  // rounding must not delay a time after whole steps by one step
  VAT_CHECK(step > 0);
  return static_cast<std::uint64_t>(std::max(Real{0}, std::ceil(time / step - kRounding)));
}

namespace {

Index find_material(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  VAT_CHECK(found != scene.materials.end());
  return static_cast<Index>(found - scene.materials.begin());
}

void add_bodies(Model& model, const std::vector<BodyId>& ids,
                std::vector<std::shared_ptr<const SampledBody>> samples) {
  const Scene& scene = model.scene;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& description = scene.bodies[b];
    ModelBody body;
    body.id = ids[b];
    body.name = description.name;
    body.kind = description.kind;
    body.material = find_material(scene, description.material);
    if (description.melting) {
      body.melts_at = first_step_from(description.melting->at, scene.numerics.step);
    }
    body.sample = std::move(samples[b]);
    model.bodies.push_back(std::move(body));
    if (model.bodies[b].sample) continue;
    model.bodies[b].sample = sample_of(model, b);
    model.bodies[b].is_as_described = true;
  }
}

/// Adds the walls, except across periodic axes and across the plane of two dimensions.
void add_walls(Model& model) {
  const Vat& vat = *model.scene.vat;
  for (int wall = 0; wall < wall_count(vat); ++wall) {
    const int axis = wall / 2;
    if (model.periodic.repeats(axis) || (model.scene.dimensions == 2 && axis == 1)) continue;
    if (model.scene.forces.walls) model.walls.push_back(wall);
    if (vat.walls[static_cast<std::size_t>(wall)].no_slip) model.no_slip_walls.push_back(wall);
  }
}

void append_particles(Model& model, ModelBody& body, Index body_index) {
  const SampledBody& sample = *body.sample;
  const auto count = static_cast<Index>(sample.positions.size());
  VAT_CHECK(sample.masses.size() == sample.positions.size() &&
            sample.radii.size() == sample.positions.size());
  body.particles = {model.particle_count, model.particle_count + count};
  model.particle_count += count;
  model.mass.insert(model.mass.end(), sample.masses.begin(), sample.masses.end());
  model.radius.insert(model.radius.end(), sample.radii.begin(), sample.radii.end());
  model.body.insert(model.body.end(), count, body_index);
  model.material.insert(model.material.end(), count, body.material);
  for (const Real mass : sample.masses) body.mass += mass;
  if (body.kind == BodyKind::rigid) {
    model.inverse_mass.insert(model.inverse_mass.end(), count, 0);
  } else {
    for (const Real mass : sample.masses) model.inverse_mass.push_back(1 / mass);
    for (const Index fixed : sample.fixed) model.inverse_mass[body.particles.begin + fixed] = 0;
    for (const NozzleParticle& each : sample.in_nozzles) {
      model.inverse_mass[body.particles.begin + each.particle] = 0;
    }
  }
}

template <class Predicate>
void append_bodies(Model& model, Predicate&& is_one) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (is_one(model.bodies[b])) append_particles(model, model.bodies[b], static_cast<Index>(b));
  }
}

void lay_out_particles(Model& model) {
  const auto is_implicit = [&](const ModelBody& body) {
    return has_implicit_springs(model.scene, model.scene.materials[body.material]);
  };
  std::size_t count = 0;
  for (const ModelBody& body : model.bodies) count += body.sample->positions.size();
  for (std::vector<Real>* column : {&model.mass, &model.inverse_mass, &model.radius}) {
    column->reserve(count);
  }
  for (std::vector<Index>* column : {&model.body, &model.material}) column->reserve(count);
  append_bodies(model, [](const ModelBody& b) { return b.kind == BodyKind::liquid; });
  model.liquid_count = model.particle_count;
  append_bodies(
      model, [&](const ModelBody& b) { return b.kind == BodyKind::deformable && !is_implicit(b); });
  model.implicit_begin = model.particle_count;
  append_bodies(
      model, [&](const ModelBody& b) { return b.kind == BodyKind::deformable && is_implicit(b); });
  model.free_count = model.particle_count;
  append_bodies(model, [](const ModelBody& b) { return b.kind == BodyKind::rigid; });
}

void set_inertia(RigidModel& rigid, const Mat3& inertia) {
  rigid.inertia = inertia;
  rigid.inverse_inertia = inertia.inverse();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);  // moments in ascending order
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes = -axes;
  rigid.principal_axes = Quat(axes).normalized();
  rigid.inverse_moments = solver.eigenvalues().cwiseInverse();
  const Vec3& w = rigid.inverse_moments;
  rigid.splitting = w[0] - w[1] < w[1] - w[2] ? std::array{0, 1, 2} : std::array{1, 2, 0};
}

/// Returns the least rotation of the x axis to a unit vector, whose x is not negative.
Quat rotation_of_x(const Vec3& to) {
  const Real scale = std::sqrt(2 * (1 + to.x()));
  return Quat(scale / 2, 0, -to.z() / scale, to.y() / scale);
}

/// Leaves only rotations about the axle free. In the plane, there are no others.
void set_axle(RigidModel& rigid, const Axle& axle, const Mat3& to_body, bool is_plane) {
  const Vec3 direction = axle.direction.normalized();
  rigid.axle = Axle{direction, axle.damping};
  rigid.inverse_mass = 0;
  if (is_plane) return;
  const Vec3 own = to_body * direction;
  const Real moment = own.dot(rigid.inertia * own);
  rigid.inverse_inertia = own * own.transpose() / moment;
  rigid.principal_axes = rotation_of_x(own.x() < 0 ? Vec3(-own) : own);
  rigid.inverse_moments = {1 / moment, 0, 0};
  rigid.splitting = {1, 2, 0};
}

std::uint64_t first_free_step(const BodyDescription& body, Real step) {
  return body.fixed || body.motion ? kNever : first_step_from(body.release, step);
}

/// Returns the data of a rigid body, and sets those of its particles, which follow from its initial
/// pose.
RigidModel make_rigid(Model& model, std::size_t index) {
  const ModelBody& body = model.bodies[index];
  const bool plane = model.scene.dimensions == 2;
  const MassProperties properties =
      plane ? plane_mass_properties(*body.sample) : mass_properties(*body.sample);
  RigidModel rigid;
  rigid.body = static_cast<Index>(index);
  rigid.particles = body.particles;
  rigid.inverse_mass = 1 / properties.mass;
  rigid.mass = 1 / rigid.inverse_mass;
  rigid.motion = model.scene.bodies[index].motion;
  rigid.free_from = first_free_step(model.scene.bodies[index], model.scene.numerics.step);
  const Mat3 to_body =
      model.scene.bodies[index].orientation.normalized().toRotationMatrix().transpose();
  // In the plane, inertia is equal in all axes, and rounding must not change this.
  set_inertia(
      rigid, plane ? properties.inertia : Mat3(to_body * properties.inertia * to_body.transpose()));
  if (const auto& axle = model.scene.bodies[index].axle) set_axle(rigid, *axle, to_body, plane);
  rigid.shape_origin = to_body * (model.scene.bodies[index].position - properties.center_of_mass);
  for (Index i = 0; i < body.particles.size(); ++i) {
    model.local_position[body.particles.begin - model.free_count + i] =
        to_body * (body.sample->positions[i] - properties.center_of_mass);
  }
  return rigid;
}

void add_rigid_bodies(Model& model) {
  model.local_position.resize(model.particle_count - model.free_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].kind != BodyKind::rigid) continue;
    model.bodies[b].rigid = static_cast<Index>(model.rigid_bodies.size());
    model.rigid_bodies.push_back(make_rigid(model, b));
  }
}

/// The spacing of the first liquid's particles at rest density, which all liquids share as they
/// share one kernel; half a support radius without particles.
Real spacing_of(const Model& model, Index material) {
  for (const ModelBody& body : model.bodies) {
    if (body.kind != BodyKind::liquid || body.particles.size() == 0) continue;
    const Real density = model.scene.materials[body.material].density;
    const Real volume = body.sample->masses.front() / density;
    const Real spacing = model.scene.dimensions == 3 ? std::cbrt(volume) : std::sqrt(volume);
    // Masses may have any value; sums over the lattice must be bounded.
    return std::max(spacing, model.scene.materials[material].liquid->support_radius / 8);
  }
  return model.scene.materials[material].liquid->support_radius / 2;
}

/// The constants of a liquid. The constant of an inactive force is zero.
LiquidModel make_liquid(const Model& model, Index material) {
  const Scene& scene = model.scene;
  Material given = scene.materials[material];
  if (scene.pressure_solver == PressureSolver::incompressible) given.liquid->stiffness = 0;
  LiquidModel liquid(scene, given, spacing_of(model, material));
  if (!scene.forces.viscosity) liquid.central_viscosity = 0;
  if (!scene.forces.pressure) liquid.stiffness = 0;
  if (!scene.forces.viscosity) liquid.viscosity = 0;
  return liquid;
}

void find_rest_volumes(Model& model) {
  model.rest_volume.resize(model.particle_count);
  VAT_CHECK(model.mass.size() == model.particle_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    std::ranges::copy(particle_volumes(model.scene, b, *body.sample),
                      model.rest_volume.begin() + body.particles.begin);
  }
}

std::vector<const SampledBody*> samples_of(const Model& model) {
  std::vector<const SampledBody*> samples;
  for (const ModelBody& body : model.bodies) samples.push_back(body.sample.get());
  return samples;
}

void take_greatest(const OscillatingPart& part, Oscillation& own) {
  own = {std::max(own.omega2, part.bound.omega2), std::max(own.rate, part.bound.rate)};
}

ModelDamping find_damping(const Model& model) {
  ModelDamping damping;
  damping.any = model.is_filled;  // momentum that the transport velocity carries
  damping.own.resize(model.bodies.size());
  damping.by_liquids.resize(model.bodies.size());
  for (const OscillatingPart& part : find_oscillating_parts(model.scene, samples_of(model))) {
    if (part.bound.rate > 0) damping.any = true;
    if (part.body) take_greatest(part, damping.own[*part.body]);
    if (part.is_of_liquid_on_solid) take_greatest(part, damping.by_liquids[*part.body]);
  }
  return damping;
}

/// The damping of one body.
Oscillation find_own_damping(const Model& model, std::size_t body) {
  Oscillation own;
  for (const OscillatingPart& part :
       find_parts_of_body(model.scene, body, *sample_of(model, body))) {
    if (part.body) take_greatest(part, own);
  }
  return own;
}

}  // namespace

namespace {

SmoothingKernel calibrated_kernel(KernelId id, Real h, int dimensions, Real spacing) {
  const SmoothingKernel kernel(id, h, dimensions);
  const Real sum = lattice_sum(kernel, h, spacing, dimensions);
  return SmoothingKernel(id, h, dimensions, 1 / sum);
}

Real central_viscosity_of(const Material& material, int dimensions) {
  const LiquidConstants& liquid = *material.liquid;
  return 2 * (dimensions + 2) * liquid.viscosity + liquid.artificial_viscosity * material.density *
                                                       std::sqrt(liquid.stiffness) *
                                                       liquid.support_radius / 2;
}

/// The maximum tension of a cohesive liquid; see core/laws/surface_tension.h.
Real tensile_strength_of(const Scene& scene, const LiquidConstants& liquid) {
  if (scene.surface_model != SurfaceModel::cohesion) return 0;
  return kTensileShare / 2 *
         attraction_of(liquid.surface_tension, liquid.support_radius, scene.dimensions);
}

}  // namespace

LiquidModel::LiquidModel(const Scene& scene, const Material& material, Real particle_spacing)
    : support_radius(material.liquid->support_radius),
      rest_density(material.density),
      stiffness(material.liquid->stiffness),
      pressure_share(scene.printed_pressure_force ? 0.5 : 1),
      viscosity(material.liquid->viscosity),
      surface_tension(material.liquid->surface_tension),
      density_kernel(support_radius, scene.dimensions),
      pressure_kernel(support_radius, scene.dimensions),
      viscosity_kernel(support_radius, scene.dimensions),
      kernel(calibrated_kernel(scene.kernel, support_radius, scene.dimensions, particle_spacing)),
      spacing(particle_spacing),
      slope_scale(1 / lattice_slope(kernel, support_radius, particle_spacing, scene.dimensions)),
      central_viscosity(central_viscosity_of(material, scene.dimensions)),
      tensile_strength(tensile_strength_of(scene, *material.liquid)),
      half_space(support_radius, scene.dimensions) {}

std::shared_ptr<const SampledBody> sample_of(const Model& model, std::size_t body) {
  const ModelBody& one = model.bodies[body];
  VAT_CHECK(body < model.bodies.size());
  if (one.sample) return one.sample;
  return std::make_shared<const SampledBody>(sample_body(
      model.scene.bodies[body], model.scene.materials[one.material], model.scene.dimensions));
}

void forget_samples(Model& model) {
  if (!model.scene.emitters.empty() || !model.scene.drains.empty()) return;
  for (ModelBody& body : model.bodies) {
    if (body.kind == BodyKind::liquid && body.is_as_described) body.sample.reset();
  }
}

std::shared_ptr<Model> compile_model(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples,
                                     const Model* whole) {
  VAT_CHECK(ids.size() == scene.bodies.size() && samples.size() == scene.bodies.size());
  auto model = std::make_shared<Model>();
  model->scene = std::move(scene);
  if (model->scene.periodic) model->periodic = PeriodicBox(*model->scene.periodic);
  if (model->scene.vat) add_walls(*model);
  for (const Emitter& emitter : model->scene.emitters) {
    model->nozzles.push_back(make_nozzle(model->scene, emitter));
  }
  add_bodies(*model, ids, std::move(samples));
  lay_out_particles(*model);
  if (whole != nullptr) model->liquids = whole->liquids;
  for (auto m = static_cast<Index>(model->liquids.size()); m < model->scene.materials.size(); ++m) {
    model->liquids.emplace_back();
    if (model->scene.materials[m].liquid) model->liquids.back() = make_liquid(*model, m);
  }
  model->is_coupled = couples_liquids(model->scene.pressure_solver) && model->liquid_count > 0;
  const bool is_tait = model->scene.pressure_solver == PressureSolver::tait;
  model->is_incompressible = model->is_coupled && !is_tait && model->scene.forces.pressure;
  if (model->is_coupled) {
    find_rest_volumes(*model);
    model->is_filled = is_tait && fills_world(model->scene, samples_of(*model));
  }
  compile_surface_tension(*model);
  add_springs(*model);
  order_implicit_springs(*model);
  find_limited_springs(*model);
  add_cells(*model);
  add_rigid_bodies(*model);
  compile_contacts(*model);
  model->damping = find_damping(*model);
  VAT_CHECK(model->liquid_count <= model->implicit_begin &&
            model->implicit_begin <= model->free_count &&
            model->free_count <= model->particle_count);
  VAT_CHECK(model->spring_begin.size() == model->free_count + 1);
  return model;
}

std::shared_ptr<Model> with_moved_body(const Model& model, std::size_t index,
                                       BodyDescription moved) {
  VAT_CHECK(index < model.bodies.size());
  auto result = std::make_shared<Model>(model);
  result->scene.bodies[index] = std::move(moved);
  ModelBody& body = result->bodies[index];
  if (body.is_as_described) {
    body.sample.reset();
    body.sample = sample_of(*result, index);
  }
  if (body.kind == BodyKind::rigid) result->rigid_bodies[body.rigid] = make_rigid(*result, index);
  compile_contacts_of_moved(*result, body);
  for (std::size_t b = 0; b < result->bodies.size(); ++b) {
    const bool may_be_old = !model.damping.is_current && result->bodies[b].kind == BodyKind::liquid;
    if (b == index || may_be_old) result->damping.own[b] = find_own_damping(*result, b);
  }
  result->damping.is_current = true;
  return result;
}

}  // namespace vat
