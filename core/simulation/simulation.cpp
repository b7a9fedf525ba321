#include "core/simulation/simulation.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <cmath>

#include "core/laws/vat_motion.h"
#include "core/model/compile.h"
#include "core/numerics/choose_numerics.h"
#include "core/simulation/measure.h"
#include "core/simulation/simulation_impl.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/step_plan.h"
#include "core/validation/validate.h"

namespace vat {

const ModelBody* Simulation::Impl::find(BodyId id) const {
  const std::vector<ModelBody>& bodies = all().bodies;
  const auto found = std::ranges::find(bodies, id, &ModelBody::id);
  return found == bodies.end() ? nullptr : &*found;
}

void Simulation::Impl::pose_rigid_particles() {
  for (std::size_t b = 0; b < model->rigid_bodies.size(); ++b) {
    pose_rigid_body(*model, model->rigid_bodies[b], state.now.rigid[b], state.now);
  }
}

Simulation::Simulation() : impl_(std::make_unique<Impl>()) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

Result<Simulation> Simulation::create(const Scene& scene, TaskRunner* runner,
                                      InstructionSet instructions) {
  if (Status available = check_available(instructions); !available) return available.errors();
  Errors errors = find_errors(scene);
  if (!errors.empty()) return errors;
  Scene resolved = scene;
  resolve_accuracy(resolved);
  Simulation simulation;
  Impl& impl = *simulation.impl_;
  impl.runner = runner;
  impl.work.instructions = impl.measured.instructions = instructions;
  std::vector<BodyId> ids;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) ids.push_back(impl.next_id++);
  std::vector<std::shared_ptr<const SampledBody>> samples(ids.size());
  const std::shared_ptr<Model> model = compile(std::move(resolved), ids, std::move(samples));
  impl.bounds = guard_bounds(*model);
  impl.step_bounds = find_step_bounds(*model);
  impl.state = initial_state(*model);
  forget_samples(*model);
  impl.model = model;
  return simulation;
}

void Simulation::Impl::adopt(Content content, GuardBounds content_bounds,
                             StepBounds content_step_bounds) noexcept {
  if (call_start.content.model == model && !call_start.bounds) {
    call_start.bounds.emplace(std::move(bounds), std::move(step_bounds));
  }
  static_cast<Content&>(*this) = std::move(content);
  bounds = std::move(content_bounds);
  step_bounds = std::move(content_step_bounds);
  local.forget();
  work.clear();
  measured.clear();
}

InstructionSet Simulation::instruction_set() const {
  return impl_->work.instructions;
}
Real Simulation::time() const {
  return impl_->time();
}
Real Simulation::step_size() const {
  return impl_->step_size();
}
std::uint32_t Simulation::steps_per_tick() const {
  return impl_->steps_per_tick();
}
std::size_t Simulation::particle_count() const {
  return impl_->all().particle_count;
}
std::size_t Simulation::greatest_particle_count() const {
  std::size_t count = 0;
  for (std::size_t b = 0; b < impl_->all().bodies.size(); ++b) {
    const std::size_t present = impl_->all().bodies[b].particles.size();
    count += std::max(present, most_particles(impl_->all().scene, impl_->all().scene.bodies[b]));
  }
  return count;
}
std::size_t Simulation::spring_count() const {
  return impl_->all().spring_ends.size() / 2;
}
std::size_t Simulation::sleeping_body_count() const {
  if (!impl_->sleepers) return 0;
  const std::vector<Index>& islands = impl_->sleepers->islands;
  return islands.size() - static_cast<std::size_t>(std::ranges::count(islands, kAwake));
}
const Scene& Simulation::scene() const {
  return impl_->all().scene;
}

namespace {

BodyView view_of(const Model& model, const Configuration& at, const ModelBody& body,
                 const Sleepers* sleepers) {
  const auto part = [&](const auto& column) {
    return std::span(column).subspan(body.particles.begin, body.particles.size());
  };
  BodyView view{body.id,
                body.name,
                body.kind,
                model.scene.materials[body.material].name,
                part(at.position),
                part(at.velocity),
                part(model.mass),
                part(model.radius),
                {},
                {}};
  if (body.sample) view.numbers = body.sample->numbers;
  view.is_asleep =
      sleepers != nullptr &&
      sleepers->islands[static_cast<std::size_t>(&body - model.bodies.data())] != kAwake;
  if (body.kind == BodyKind::rigid) {
    const RigidModel& rigid = model.rigid_bodies[body.rigid];
    const RigidState& state = at.rigid[body.rigid];
    view.pose =
        RigidPose{state.center_of_mass, state.orientation, rigid.inverse_mass * state.momentum,
                  angular_velocity(rigid, state.orientation, state.angular_momentum)};
    view.local_positions =
        std::span(model.local_position)
            .subspan(body.particles.begin - model.free_count, body.particles.size());
  }
  return view;
}

}  // namespace

std::vector<BodyView> Simulation::bodies() const {
  std::vector<BodyView> views;
  list_bodies(views);
  return views;
}

void Simulation::list_bodies(std::vector<BodyView>& views) const {
  views.clear();
  views.reserve(impl_->all().bodies.size());
  for (const ModelBody& body : impl_->all().bodies) {
    views.push_back(view_of(impl_->all(), impl_->all_now(), body, impl_->sleepers.get()));
  }
}

std::optional<BodyView> Simulation::find_body(BodyId id) const {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return {};
  return view_of(impl_->all(), impl_->all_now(), *body, impl_->sleepers.get());
}

std::optional<BodyId> Simulation::find_body(std::string_view name) const {
  const auto found = std::ranges::find(impl_->all().bodies, name, &ModelBody::name);
  if (found == impl_->all().bodies.end()) return {};
  return found->id;
}

Vec3 Simulation::vat_offset() const {
  const std::optional<Vat>& vat = impl_->all().scene.vat;
  return vat ? vat_motion(*vat, impl_->time()).offset : Vec3(Vec3::Zero());
}

Diagnostics Simulation::diagnostics() const {
  const ForceModel force_model{impl_->all(),  impl_->controls, impl_->measured,
                               impl_->runner, nullptr,         impl_->state.step_count};
  Diagnostics result = measure(force_model, impl_->all_now(), impl_->time());
  result.emitted_particles = impl_->state.emitted;
  result.drained_particles = impl_->state.drained;
  result.sleeping_bodies = sleeping_body_count();
  if (impl_->all().is_incompressible) result.volume = impl_->state.volume;
  return result;
}

Result<LiquidFields> Simulation::liquid_fields(BodyId id) const {
  LiquidFields fields;
  if (Status measured = measure_liquid(id, fields); !measured) return measured.errors();
  return fields;
}

Status Simulation::measure_liquid(BodyId id, LiquidFields& fields) const {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return Error{"no_such_body", "/body", "there is no such body"};
  if (body->kind != BodyKind::liquid) {
    return Error{"not_liquid", "/body", "body '" + body->name + "' is not liquid"};
  }
  diagnostics();  // leaves density and pressure of the present positions in `measured`
  const auto copy = [&](const std::vector<Real>& column, std::vector<Real>& part) {
    part.assign(column.begin() + body->particles.begin, column.begin() + body->particles.end);
  };
  copy(impl_->measured.of<LiquidScratch>().density, fields.density);
  copy(impl_->measured.of<LiquidScratch>().pressure, fields.pressure);
  return {};
}

std::string Simulation::plan_text() const {
  return to_text(impl_->all().plan);
}
void Simulation::set_observer(StageObserver* observer) {
  impl_->observer = observer;
}

}  // namespace vat
