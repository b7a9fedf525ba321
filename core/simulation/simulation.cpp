#include "core/simulation/simulation.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>

#include "core/laws/vat_motion.h"
#include "core/model/compile.h"
#include "core/numerics/choose_numerics.h"
#include "core/simulation/measure.h"
#include "core/simulation/simulation_impl.h"
#include "core/sleep/islands.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/local_levels.h"
#include "core/stepping/step_plan.h"
#include "core/support/check.h"
#include "core/validation/validate.h"

namespace vat {

const ModelBody* SimulationImpl::find(BodyId id) const {
  const std::vector<ModelBody>& bodies = all().bodies;
  const auto found = std::ranges::find(bodies, id, &ModelBody::id);
  return found == bodies.end() ? nullptr : &*found;
}

const ModelBody* SimulationImpl::find(std::string_view name) const {
  const std::vector<ModelBody>& bodies = all().bodies;
  const auto found = std::ranges::find(bodies, name, &ModelBody::name);
  return found == bodies.end() ? nullptr : &*found;
}

void SimulationImpl::pose_rigid_particles() {
  for (std::size_t b = 0; b < model->rigid_bodies.size(); ++b) {
    pose_rigid_body(*model, model->rigid_bodies[b], state.now.rigid[b], state.now);
  }
}

HostInterface::Data::Data() : impl_(std::make_unique<SimulationImpl>()) {}
HostInterface::Data::Data(Data&&) noexcept = default;
HostInterface::Data& HostInterface::Data::operator=(Data&&) noexcept = default;
HostInterface::Data::~Data() = default;

SimulationImpl* HostInterface::Data::operator->() const {
  impl_->read_from_device();
  return impl_.get();
}
SimulationImpl* HostInterface::Data::operator->() {
  impl_->read_from_device();
  impl_->device_is_current = false;
  return impl_.get();
}

HostInterface::HostInterface() = default;
HostInterface::HostInterface(HostInterface&&) noexcept = default;
HostInterface& HostInterface::operator=(HostInterface&&) noexcept = default;
HostInterface::~HostInterface() = default;

Simulation::Simulation() = default;
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
  SimulationImpl& impl = *simulation.impl_;
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

void SimulationImpl::adopt(SimulationContent content, GuardBounds content_bounds,
                           StepBounds content_step_bounds) noexcept {
  if (call_start.content.model == model && !call_start.bounds) {
    call_start.bounds.emplace(std::move(bounds), std::move(step_bounds));
  }
  VAT_CHECK(content.model != nullptr &&
            content_bounds.travel.size() == content.model->bodies.size());
  static_cast<SimulationContent&>(*this) = std::move(content);
  bounds = std::move(content_bounds);
  step_bounds = std::move(content_step_bounds);
  stepper.forget();
  work.clear();
  measured.clear();
}

InstructionSet Simulation::instruction_set() const {
  return impl_.unread().work.instructions;
}
const std::shared_ptr<const Model>& SimulationImpl::model_of_all() const {
  return sleepers ? sleepers->model : model;
}

Status Simulation::set_engine(std::unique_ptr<StepEngine> engine) {
  VAT_CHECK(engine != nullptr);
  // The engine must have the features of sleeping bodies, too.
  std::shared_ptr<const Model> all = impl_->model_of_all();
  if (Status bound = engine->bind(all, guard_bounds(*all)); !bound) return bound;
  impl_->engine = std::move(engine);
  impl_->engine_model = std::move(all);
  impl_->engine_fits = true;
  return {};
}
Status Simulation::resume_engine(std::unique_ptr<StepEngine> engine) {
  VAT_CHECK(engine != nullptr);
  std::shared_ptr<const Model> all = impl_->model_of_all();
  const Status bound = engine->bind(all, guard_bounds(*all));
  if (!bound && !lacks_features(bound)) return bound;
  impl_->engine = std::move(engine);
  impl_->engine_model = std::move(all);
  impl_->engine_fits = bound.ok();
  return {};
}
bool Simulation::has_engine() const {
  return impl_.unread().engine != nullptr;
}
std::string_view Simulation::arithmetic() const {
  const SimulationImpl& impl = impl_.unread();
  return impl.engine ? impl.engine->arithmetic() : to_string(impl.work.instructions);
}
Real Simulation::time() const {
  return impl_.unread().time();
}
Real Simulation::step_size() const {
  return impl_.unread().step_size();
}
std::uint32_t Simulation::steps_per_tick() const {
  return impl_.unread().steps_per_tick();
}
std::size_t Simulation::particle_count() const {
  return impl_.unread().all().particle_count;
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
  return impl_.unread().all().scene;
}

BodyView SimulationImpl::view_of(const ModelBody& body) const {
  const Configuration& at = all_now();
  VAT_CHECK(body.particles.begin <= body.particles.end);
  VAT_CHECK(body.particles.end <= at.position.size());
  const auto part = [&](const auto& column) {
    return std::span(column).subspan(body.particles.begin, body.particles.size());
  };
  BodyView view{body.id,
                body.name,
                body.kind,
                all().scene.materials[body.material].name,
                part(at.position),
                part(at.velocity),
                part(all().mass),
                part(all().radius),
                {},
                {}};
  if (body.sample) view.numbers = body.sample->numbers;
  const auto index = static_cast<std::size_t>(&body - all().bodies.data());
  VAT_CHECK(index < all().bodies.size());
  view.is_asleep = sleepers && sleepers->islands[index] != kAwake;
  if (body.kind == BodyKind::rigid) {
    const RigidModel& rigid = all().rigid_bodies[body.rigid];
    const RigidState& rigid_state = at.rigid[body.rigid];
    view.pose =
        RigidPose{rigid_state.center_of_mass, rigid_state.orientation,
                  rigid.inverse_mass * rigid_state.momentum,
                  angular_velocity(rigid, rigid_state.orientation, rigid_state.angular_momentum)};
    view.shape_origin = rigid.shape_origin;
    view.local_positions =
        std::span(all().local_position)
            .subspan(body.particles.begin - all().free_count, body.particles.size());
  }
  return view;
}

std::vector<BodyView> Simulation::bodies() const {
  std::vector<BodyView> views;
  list_bodies(views);
  return views;
}

void HostInterface::list_bodies(std::vector<BodyView>& views) const {
  views.clear();
  views.reserve(impl_->all().bodies.size());
  for (const ModelBody& body : impl_->all().bodies) {
    views.push_back(impl_->view_of(body));
  }
}

std::optional<BodyView> Simulation::find_body(BodyId id) const {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return {};
  return impl_->view_of(*body);
}

std::optional<BodyId> Simulation::find_body(std::string_view name) const {
  const ModelBody* body = impl_->find(name);
  return body == nullptr ? std::nullopt : std::optional(body->id);
}

std::shared_ptr<const void> Simulation::keep_views() {
  struct Kept {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const Sleepers> sleepers;
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities;
  };
  Configuration& now = impl_->sleepers ? impl_->shown : impl_->state.now;
  auto kept =
      std::make_shared<Kept>(Kept{impl_->model, impl_->sleepers, now.position, now.velocity});
  kept->positions.swap(now.position);
  kept->velocities.swap(now.velocity);
  return kept;
}

Vec3 Simulation::vat_offset() const {
  const std::optional<Vat>& vat = impl_->all().scene.vat;
  return vat ? vat_motion(*vat, impl_->time()).offset : Vec3(Vec3::Zero());
}

Diagnostics Simulation::diagnostics() const {
  Diagnostics result = impl_->measure_all();
  result.emitted_particles = impl_->state.emitted;
  result.drained_particles = impl_->state.drained;
  result.sleeping_bodies = sleeping_body_count();
  if (impl_->all().is_incompressible) result.volume = impl_->state.volume;
  return result;
}

Diagnostics SimulationImpl::measure_all() const {
  const ForceModel force_model{all(), controls, measured, runner, nullptr, state.step_count};
  return measure(force_model, all_now(), time());
}

Result<LiquidFields> Simulation::liquid_fields(BodyId id) const {
  LiquidFields fields;
  if (Status measured = measure_liquid(id, fields); !measured) return measured.errors();
  return fields;
}

Status HostInterface::measure_liquid(BodyId id, LiquidFields& fields) const {
  const ModelBody* body = impl_->find(id);
  if (body == nullptr) return Error{"no_such_body", "/body", "there is no such body"};
  if (body->kind != BodyKind::liquid) {
    return Error{"not_liquid", "/body", "body '" + body->name + "' is not liquid"};
  }
  impl_->measure_all();
  impl_->copy_fields(*body, fields);
  return {};
}

std::vector<LiquidFields> Simulation::liquid_fields() const {
  const std::vector<ModelBody>& bodies = impl_->all().bodies;
  std::vector<LiquidFields> fields(bodies.size());
  const auto is_liquid = [](const ModelBody& body) { return body.kind == BodyKind::liquid; };
  if (std::ranges::none_of(bodies, is_liquid)) return fields;
  impl_->measure_all();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (is_liquid(bodies[i])) impl_->copy_fields(bodies[i], fields[i]);
  }
  return fields;
}

void SimulationImpl::copy_fields(const ModelBody& body, LiquidFields& fields) const {
  const auto copy = [&](const std::vector<Real>& column, std::vector<Real>& part) {
    VAT_CHECK(column.size() >= body.particles.end);
    part.assign(column.begin() + body.particles.begin, column.begin() + body.particles.end);
  };
  copy(measured.of<LiquidScratch>().density, fields.density);
  copy(measured.of<LiquidScratch>().pressure, fields.pressure);
}

std::string Simulation::plan_text() const {
  return to_text(impl_->all().plan) + describe_sub_steps(impl_->all());
}
void Simulation::set_observer(StageObserver* observer) {
  impl_->observer = observer;
}

}  // namespace vat
