// Snapshots of a simulation, and their bytes.

#include <algorithm>

#include "core/limits.h"
#include "core/model/compile.h"
#include "core/saved/check_saved.h"
#include "core/saved/saved_fields.h"
#include "core/saved/sealed_bytes.h"
#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/state/body_state.h"
#include "core/stepping/step_plan.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Since version 2, the state is followed by the motion of the vat by a user, which may be absent,
/// and the appearances of the materials. Since version 3, the motions and axles of the bodies
/// follow, and since version 4 their sub-steps. Version 1 ends with the motion of the vat, if there
/// is one.
constexpr Seal kSeal{"vat.sim\n", 4, "a saved simulation", 1};

/// The members of a body that its description in the bytes of a scene lacks.
struct Guidance {
  std::optional<SlideMotion> motion;
  std::optional<Axle> axle;
};

std::vector<Guidance> guidances_of(const Scene& scene) {
  std::vector<Guidance> guidances;
  for (const BodyDescription& body : scene.bodies) guidances.push_back({body.motion, body.axle});
  return guidances;
}

std::vector<std::uint32_t> sub_steps_of(const Scene& scene) {
  std::vector<std::uint32_t> sub_steps;
  for (const BodyDescription& body : scene.bodies) sub_steps.push_back(body.sub_steps);
  return sub_steps;
}

bool are_sub_steps(const std::vector<std::uint32_t>& values) {
  return std::ranges::all_of(values,
                             [](std::uint32_t one) { return one >= 1 && one <= kMaxSubSteps; });
}

std::vector<Appearance> appearances_of(const Scene& scene) {
  std::vector<Appearance> appearances;
  for (const Material& material : scene.materials) appearances.push_back(material.appearance);
  return appearances;
}

}  // namespace

Snapshot Simulation::snapshot() const {
  return {std::make_shared<const SimulationContent>(*impl_), impl_->next_id,
          impl_->work.instructions};
}

Simulation Simulation::from(const Snapshot& snapshot, TaskRunner* runner) {
  Simulation simulation;
  simulation.impl_->runner = runner;
  simulation.impl_->work.instructions = snapshot.instructions_;
  simulation.impl_->measured.instructions = snapshot.instructions_;
  simulation.restore(snapshot);
  return simulation;
}

void Simulation::restore(const Snapshot& snapshot) {
  VAT_CHECK(snapshot.instructions_ == impl_->work.instructions);
  const SimulationContent& content = *snapshot.content_;
  impl_->adopt(content, SimulationImpl::bounds_of(content), find_step_bounds(*content.model));
  impl_->next_id = std::max(impl_->next_id, snapshot.next_id_);
  impl_->show();
}

Snapshot::Snapshot(std::shared_ptr<const SimulationContent> content, BodyId next_id,
                   InstructionSet instructions)
    : content_(std::move(content)), next_id_(next_id), instructions_(instructions) {}
Snapshot::Snapshot(const Snapshot&) = default;
Snapshot::Snapshot(Snapshot&&) noexcept = default;
Snapshot& Snapshot::operator=(const Snapshot&) = default;
Snapshot& Snapshot::operator=(Snapshot&&) noexcept = default;
Snapshot::~Snapshot() = default;

std::uint64_t Snapshot::state_hash() const {
  return content_->hash();
}
const Scene& Snapshot::scene() const {
  return content_->all().scene;
}

namespace {

/// The data of a body that do not follow from its description: the sample of a liquid after inflow,
/// outflow or melting. Its damping is that for the gravity at its compilation.
SavedBody saved_body(const Model& model, std::size_t index) {
  const ModelBody& body = model.bodies[index];
  SavedBody saved{body.id, model.damping.own[index], {}};
  if (body.sample == nullptr || body.is_as_described) return saved;
  VAT_CHECK(body.kind == BodyKind::liquid);
  saved.sample = *body.sample;
  return saved;
}

/// The model of all bodies, as at the time of saving.
std::shared_ptr<const Model> compile_saved(Scene scene, std::vector<SavedBody> bodies) {
  std::vector<BodyId> ids;
  std::vector<std::shared_ptr<const SampledBody>> samples;
  for (SavedBody& body : bodies) {
    ids.push_back(body.id);
    samples.push_back(body.sample ? std::make_shared<const SampledBody>(std::move(*body.sample))
                                  : nullptr);
  }
  const std::shared_ptr<Model> model = compile(std::move(scene), ids, std::move(samples));
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Oscillation& own = model->damping.own[b];
    model->damping.is_current = model->damping.is_current && own == bodies[b].damping;
    own = bodies[b].damping;
  }
  forget_samples(*model);
  return model;
}

Status bad_bytes(const LoadingArchive& archive) {
  if (archive.failed())
    return Error{"bad_value", "", "the values of the saved simulation are incomplete"};
  if (archive.left() > 0) return Error{"bad_value", "", "the saved simulation has surplus bytes"};
  return {};
}

/// Reads the end of the bytes, which depends on their version.
Status load_additions(LoadingArchive& archive, std::uint32_t version, Scene& scene) {
  std::optional<HandMotion> hand;
  std::vector<Appearance> appearances(scene.materials.size());
  std::vector<Guidance> guidances(scene.bodies.size());
  std::vector<std::uint32_t> sub_steps(scene.bodies.size(), 1);
  if (version >= 2) {
    archive(hand, appearances);
    if (version >= 3) archive(guidances);
    if (version >= 4) archive(sub_steps);
  } else if (archive.left() > 0 && scene.vat) {
    archive(hand.emplace());
  }
  if (Status status = bad_bytes(archive); !status) return status;
  if (appearances.size() != scene.materials.size() || guidances.size() != scene.bodies.size() ||
      sub_steps.size() != scene.bodies.size() || !are_sub_steps(sub_steps) ||
      (hand && !scene.vat)) {
    return Error{"bad_value", "", "the end of the saved simulation does not fit its scene"};
  }
  for (std::size_t m = 0; m < appearances.size(); ++m) {
    scene.materials[m].appearance = appearances[m];
  }
  for (std::size_t b = 0; b < guidances.size(); ++b) {
    scene.bodies[b].motion = guidances[b].motion;
    scene.bodies[b].axle = guidances[b].axle;
    scene.bodies[b].sub_steps = sub_steps[b];
  }
  if (!hand) return {};
  if (Status status = check_saved_hand(*hand); !status) return status;
  scene.vat->hand = hand;
  return {};
}

}  // namespace

std::vector<std::uint8_t> Snapshot::to_bytes() const {
  std::vector<std::uint8_t> bytes = begin_sealed(kSeal);
  SavingArchive archive(bytes);
  const Model& all = content_->all();
  std::vector<SavedBody> bodies;
  for (std::size_t b = 0; b < all.bodies.size(); ++b) bodies.push_back(saved_body(all, b));
  archive(instructions_, content_->hash(), all.scene, next_id_, bodies,
          content_->sleepers != nullptr);
  if (content_->sleepers) archive(content_->sleepers->configuration, content_->sleepers->islands);
  archive(content_->state, content_->controls);
  archive(all.scene.vat ? all.scene.vat->hand : std::nullopt, appearances_of(all.scene),
          guidances_of(all.scene), sub_steps_of(all.scene));
  close_seal(bytes);
  return bytes;
}

Result<Simulation> Simulation::load(std::span<const std::uint8_t> bytes, TaskRunner* runner,
                                    std::optional<InstructionSet> instructions) {
  const auto content = open_sealed(kSeal, bytes);
  if (!content) return content.errors();
  LoadingArchive archive(content.value());
  InstructionSet saved{};
  archive(saved);
  if (archive.failed()) {
    return Error{"bad_value", "/instruction_set", "must be known to this program"};
  }
  if (instructions.value_or(saved) != saved) {
    return Error{"other_instruction_set", "/instruction_set",
                 std::string("the simulation was saved with the instruction set ") +
                     to_string(saved) + ", not " + to_string(*instructions)};
  }
  if (Status available = check_available(saved); !available) return available.errors();
  Simulation simulation;
  SimulationImpl& impl = *simulation.impl_;
  impl.runner = runner;
  impl.work.instructions = impl.measured.instructions = saved;
  if (Status loaded = impl.load(archive, sealed_version(bytes)); !loaded) return loaded.errors();
  return simulation;
}

Status SimulationImpl::load(LoadingArchive& archive, std::uint32_t version) {
  std::uint64_t saved_hash = 0;
  Scene scene;
  std::vector<SavedBody> bodies;
  bool some_sleep = false;
  Configuration configuration;
  std::vector<Index> islands;
  archive(saved_hash, scene, next_id, bodies, some_sleep);
  if (some_sleep) archive(configuration, islands);
  SimulationContent content;
  archive(content.state, content.controls);
  if (Status status = load_additions(archive, version, scene); !status) return status;
  if (Status status = check_saved_scene(scene, bodies, next_id); !status) return status;

  content.model = compile_saved(std::move(scene), std::move(bodies));
  if (some_sleep) {
    if (Status status = check_saved_sleepers(*content.model, configuration, islands); !status) {
      return status;
    }
    content.sleepers = std::make_shared<const Sleepers>(content.model, std::move(configuration),
                                                        std::move(islands));
    content.model = compile_awake(*content.model, content.sleepers->islands);
  }
  if (!content.state.forces_current) content.state.forces = no_forces(*content.model);
  if (Status status = check_saved_state(*content.model, content.state); !status) return status;
  if (Status status = check_saved_controls(*content.model, content.controls); !status) {
    return status;
  }
  if (content.hash() != saved_hash) {
    return Error{"bad_value", "/hash", "the state does not have its saved hash"};
  }
  GuardBounds content_bounds = bounds_of(content);
  StepBounds content_step_bounds = find_step_bounds(*content.model);
  adopt(std::move(content), std::move(content_bounds), std::move(content_step_bounds));
  show();
  return {};
}

}  // namespace vat
