#include "core/model/compile.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "core/model/contacts.h"
#include "core/rigid/mass_properties.h"
#include "core/scene/step_limits.h"
#include "core/support/check.h"

namespace vat {
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
    body.sample = samples[b] ? std::move(samples[b])
                             : std::make_shared<const SampledBody>(
                                   sample_body(description, scene.materials[body.material]));
    model.bodies.push_back(std::move(body));
  }
}

void append_particles(Model& model, ModelBody& body, Index body_index) {
  const SampledBody& sample = *body.sample;
  const auto count = static_cast<Index>(sample.positions.size());
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
  }
}

void lay_out_particles(Model& model) {
  for (const BodyKind kind : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      if (model.bodies[b].kind == kind) {
        append_particles(model, model.bodies[b], static_cast<Index>(b));
      }
    }
    if (kind == BodyKind::liquid) model.liquid_count = model.particle_count;
    if (kind == BodyKind::deformable) model.free_count = model.particle_count;
  }
}

void add_springs(Model& model) {
  std::vector<std::vector<SpringEnd>> ends(model.free_count);
  for (const ModelBody& body : model.bodies) {
    const Index first = body.particles.begin;
    for (const SampledSpring& spring : body.sample->springs) {
      const auto end_at = [&](Index other) {
        return SpringEnd{first + other, spring.stiffness, spring.damping, spring.rest_length};
      };
      ends[first + spring.a].push_back(end_at(spring.b));
      ends[first + spring.b].push_back(end_at(spring.a));
    }
  }
  model.spring_begin.push_back(0);
  for (std::vector<SpringEnd>& of_particle : ends) {
    std::ranges::stable_sort(of_particle, {}, &SpringEnd::other);
    model.spring_ends.insert(model.spring_ends.end(), of_particle.begin(), of_particle.end());
    model.spring_begin.push_back(static_cast<Index>(model.spring_ends.size()));
  }
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

void add_rigid_bodies(Model& model) {
  model.local_position.resize(model.particle_count - model.free_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    ModelBody& body = model.bodies[b];
    if (body.kind != BodyKind::rigid) continue;
    const MassProperties properties = mass_properties(*body.sample);
    body.rigid = static_cast<Index>(model.rigid_bodies.size());
    RigidModel rigid;
    rigid.body = static_cast<Index>(b);
    rigid.particles = body.particles;
    rigid.inverse_mass = 1 / properties.mass;
    const Mat3 to_body =
        model.scene.bodies[b].orientation.normalized().toRotationMatrix().transpose();
    set_inertia(rigid, to_body * properties.inertia * to_body.transpose());
    model.rigid_bodies.push_back(rigid);
    for (Index i = 0; i < body.particles.size(); ++i) {
      model.local_position[body.particles.begin - model.free_count + i] =
          to_body * (body.sample->positions[i] - properties.center_of_mass);
    }
  }
}

ModelDamping find_damping(const Model& model) {
  std::vector<const SampledBody*> samples;
  for (const ModelBody& body : model.bodies) samples.push_back(body.sample.get());
  ModelDamping damping;
  for (const OscillatingPart& part : find_oscillating_parts(model.scene, samples)) {
    if (part.bound.rate > 0) damping.bounds.push_back(part.bound);
  }
  damping.any = !damping.bounds.empty();
  return damping;
}

}  // namespace

LiquidModel::LiquidModel(const Material& material)
    : support_radius(material.liquid->support_radius),
      rest_density(material.density),
      stiffness(material.liquid->stiffness),
      viscosity(material.liquid->viscosity),
      density_kernel(support_radius),
      pressure_kernel(support_radius),
      viscosity_kernel(support_radius) {}

std::shared_ptr<const Model> compile(Scene scene, const std::vector<BodyId>& ids,
                                     std::vector<std::shared_ptr<const SampledBody>> samples) {
  VAT_CHECK(ids.size() == scene.bodies.size() && samples.size() == scene.bodies.size());
  auto model = std::make_shared<Model>();
  model->scene = std::move(scene);
  add_bodies(*model, ids, std::move(samples));
  lay_out_particles(*model);
  for (const Material& material : model->scene.materials) {
    model->liquids.push_back(material.liquid ? std::optional(LiquidModel(material)) : std::nullopt);
  }
  add_springs(*model);
  add_rigid_bodies(*model);
  compile_contacts(*model);
  model->damping = find_damping(*model);
  model->plan = make_step_plan(*model);
  return model;
}

}  // namespace vat
