#include "core/coupling/coupled_simulation.h"

#include <algorithm>
#include <string>

#include "core/saved/archive.h"
#include "core/saved/sealed_bytes.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Seal kCouplingSeal{"vat.cpl\n", 1, "a saved coupled simulation"};

/// Part of the bytes of a coupled simulation.
struct SavedExternal {
  BodyId id = 0;
  std::vector<std::uint8_t> state;
};

template <class Archive>
void describe(Archive& archive, Of<Archive, SavedExternal>& v) {
  archive(v.id, v.state);
}

Error not_attachable(std::string reason) {
  return {"not_allowed", "/body", std::move(reason)};
}

void read_motion(const BodyView& body, BodyMotion& motion) {
  motion.pose = body.pose;
  if (body.pose) return;
  motion.positions.assign(body.positions.begin(), body.positions.end());
  motion.velocities.assign(body.velocities.begin(), body.velocities.end());
}

Real mass_of(const BodyView& body) {
  Real mass = 0;
  for (const Real particle : body.masses) mass += particle;
  return mass;
}

void add_report(const AdvanceReport& step, AdvanceReport& sum) {
  sum.undone_steps += step.undone_steps;
  sum.wall_stops += step.wall_stops;
  sum.unsolved_drifts += step.unsolved_drifts;
  sum.force_evaluations += step.force_evaluations;
  sum.particle_evaluations += step.particle_evaluations;
  sum.iterations.contacts += step.iterations.contacts;
  sum.iterations.damping += step.iterations.damping;
  sum.iterations.springs += step.iterations.springs;
  sum.iterations.elongation += step.iterations.elongation;
  sum.iterations.velocities += step.iterations.velocities;
  sum.iterations.places += step.iterations.places;
  sum.device_steps += step.device_steps;
  if (step.device_error) sum.device_error = step.device_error;
  if (step.steps > 0) sum.count_steps(step.steps, step.least_step, step.greatest_step);
  sum.bodies_changed = sum.bodies_changed || step.bodies_changed;
  sum.ended_grabs.insert(sum.ended_grabs.end(), step.ended_grabs.begin(), step.ended_grabs.end());
  sum.failed = step.failed;
  for (const GuardEvent& event : step.events) sum.add(event);
}

Errors with_prefix(Errors errors, const std::string& prefix) {
  for (Error& error : errors) error.path = prefix + error.path;
  return errors;
}

}  // namespace

struct CoupledSimulation::Attached {
  BodyId id;
  std::unique_ptr<ExternalBody> body;
  BodyMotion motion;                                 ///< argument of the external body
  RigidMomentum before{Vec3::Zero(), Vec3::Zero()};  ///< at the start of the step; rigid bodies
  std::vector<Vec3> impulses{};                      ///< on the particles of other bodies
};

CoupledSimulation::CoupledSimulation(Simulation simulation) : simulation_(std::move(simulation)) {}
CoupledSimulation::CoupledSimulation(CoupledSimulation&&) noexcept = default;
CoupledSimulation& CoupledSimulation::operator=(CoupledSimulation&&) noexcept = default;
CoupledSimulation::~CoupledSimulation() = default;

Status CoupledSimulation::check(BodyId id) const {
  const std::vector<BodyView> bodies = simulation_.bodies();
  const auto found = std::ranges::find(bodies, id, &BodyView::id);
  if (found == bodies.end()) {
    return Error{"no_such_body", "/body", "there is no body with this id"};
  }
  if (std::ranges::find(attached_, id, &Attached::id) != attached_.end()) {
    return not_attachable("must not be attached already");
  }
  const Scene& scene = simulation_.scene();
  const BodyDescription& body = scene.bodies[static_cast<std::size_t>(found - bodies.begin())];
  const Material& material = material_of(scene, body);
  if (found->kind == BodyKind::liquid) return not_attachable("must be rigid or deformable");
  if (body.fixed || body.motion || body.axle || body.release > simulation_.time()) {
    return not_attachable("must be neither held, driven nor on an axle");
  }
  if (found->kind == BodyKind::rigid) return {};
  if (body.melting) return not_attachable("must not melt");
  if (material.springs || material.bulk_modulus > 0 || !body.springs.empty()) {
    return not_attachable("must have neither springs nor a bulk modulus");
  }
  const auto* particles = std::get_if<ParticleShape>(&body.shape);
  if (particles != nullptr && !particles->fixed.empty()) {
    return not_attachable("must not have fixed particles");
  }
  return {};
}

Status CoupledSimulation::attach(BodyId id, std::unique_ptr<ExternalBody> body) {
  VAT_CHECK(body != nullptr);
  if (Status status = check(id); !status) return status;
  Attached attached{id, std::move(body), {}};
  const BodyView view = *simulation_.find_body(id);
  read_motion(view, attached.motion);
  attached.body->start(simulation_.time(), view, attached.motion);
  if (Status set = simulation_.set_body_motion(id, attached.motion); !set) return set;
  attached_.push_back(std::move(attached));
  return {};
}

Status CoupledSimulation::detach(BodyId id) {
  if (std::erase_if(attached_, [id](const Attached& each) { return each.id == id; }) > 0) return {};
  return Error{"not_attached", "/body", "is not attached"};
}

void CoupledSimulation::read_momenta() {
  for (Attached& each : attached_) {
    const BodyView view = *simulation_.find_body(each.id);
    if (view.pose) {
      each.before = *simulation_.rigid_momentum(each.id);
      continue;
    }
    each.impulses.resize(view.velocities.size());
    for (std::size_t i = 0; i < each.impulses.size(); ++i) {
      each.impulses[i] = -view.masses[i] * view.velocities[i];
    }
  }
}

Status CoupledSimulation::exchange(const CouplingInterval& interval) {
  const Scene& scene = simulation_.scene();
  const Vec3 gravity = scene.forces.gravity ? scene.gravity : Vec3(Vec3::Zero());
  const Vec3 fall = interval.length() * gravity;
  for (Attached& each : attached_) {
    const BodyView view = *simulation_.find_body(each.id);
    ReceivedImpulses received;
    if (view.pose) {
      const RigidMomentum after = *simulation_.rigid_momentum(each.id);
      received.linear = after.linear - each.before.linear - mass_of(view) * fall;
      received.angular = after.angular - each.before.angular;
    } else {
      for (std::size_t i = 0; i < each.impulses.size(); ++i) {
        each.impulses[i] += view.masses[i] * (view.velocities[i] - fall);
        received.linear += each.impulses[i];
      }
      received.particles = each.impulses;
    }
    const std::string name(view.name);
    read_motion(view, each.motion);
    each.body->advance(interval, received, each.motion);
    if (Status set = simulation_.set_body_motion(each.id, each.motion); !set) {
      return with_prefix(set.errors(), "/bodies/" + name);
    }
  }
  return {};
}

Result<AdvanceReport> CoupledSimulation::advance(std::uint32_t steps) {
  AdvanceReport sum;
  for (std::uint32_t s = 0; s < steps && !sum.failed; ++s) {
    if (ended_) return *ended_;
    std::erase_if(attached_,
                  [this](const Attached& each) { return !simulation_.find_body(each.id); });
    read_momenta();
    const Real start = simulation_.time();
    const AdvanceReport report = simulation_.advance(1);
    add_report(report, sum);
    if (report.failed) break;
    ended_ = {{"ended", "/bodies", "an external body has thrown an exception"}};
    const Status exchanged = exchange({start, simulation_.time()});
    ended_.reset();
    if (!exchanged) ended_ = exchanged.errors();
  }
  if (ended_) return *ended_;
  return sum;
}

Result<std::vector<std::uint8_t>> CoupledSimulation::save() const {
  if (ended_) return *ended_;
  std::vector<SavedExternal> externals;
  for (const Attached& each : attached_) {
    std::optional<std::vector<std::uint8_t>> state = each.body->save();
    if (!state) {
      const std::optional<BodyView> body = simulation_.find_body(each.id);
      return Error{"not_restorable", "/bodies/" + (body ? std::string(body->name) : ""),
                   "the external simulator of this body cannot be saved"};
    }
    externals.push_back({each.id, std::move(*state)});
  }
  std::vector<std::uint8_t> bytes = begin_sealed(kCouplingSeal);
  SavingArchive archive(bytes);
  archive(externals, simulation_.snapshot().to_bytes());
  close_seal(bytes);
  return bytes;
}

Result<CoupledSimulation> CoupledSimulation::load(std::span<const std::uint8_t> bytes,
                                                  const MakeBody& make, TaskRunner* runner) {
  const auto content = open_sealed(kCouplingSeal, bytes);
  if (!content) return content.errors();
  LoadingArchive archive(content.value());
  std::vector<SavedExternal> externals;
  std::vector<std::uint8_t> scene;
  archive(externals, scene);
  if (archive.failed() || archive.left() > 0) {
    return Error{"bad_value", "", "the values of the saved simulation are incomplete"};
  }
  Result<Simulation> simulation = Simulation::load(scene, runner);
  if (!simulation) return simulation.errors();
  CoupledSimulation coupled(std::move(simulation).value());
  for (const SavedExternal& saved : externals) {
    if (Status status = coupled.check(saved.id); !status) return status.errors();
    const BodyView view = *coupled.simulation_.find_body(saved.id);
    std::unique_ptr<ExternalBody> body = make(view.name);
    if (body == nullptr || !body->restore(saved.state)) {
      return Error{"not_restored", "/bodies/" + std::string(view.name),
                   "the external simulator of this body cannot be restored"};
    }
    coupled.attached_.push_back({saved.id, std::move(body), {}});
  }
  return coupled;
}

}  // namespace vat
