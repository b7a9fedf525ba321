#include "protocol/recording/frame_recorder.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "protocol/frame/frame_domain.h"
#include "protocol/messages/describe.h"
#include "protocol/scene/level.h"

namespace vat {
namespace {

constexpr std::size_t kMinKeyInterval = 4;
constexpr std::size_t kMaxKeyInterval = 60;
constexpr std::size_t kParticlesBetweenKeys = 500'000;  // of all frames together

bool fits_grid(const FrameGrid& grid, const PublishedState& state) {
  const Vec3 min(grid.origin[0], grid.origin[1], grid.origin[2]);
  const Vec3 max = min + Vec3::Constant(65'535 * grid.quantum);
  for (const PublishedState::Body& body : state.bodies) {
    for (const Vec3& position : body.positions) {
      if ((position.array() < min.array()).any() || (position.array() > max.array()).any()) {
        return false;
      }
    }
  }
  return true;
}

GridBlock::Kind grid_kind(BodyKind kind) {
  switch (kind) {
    case BodyKind::liquid:
      return GridBlock::Kind::liquid;
    case BodyKind::deformable:
      return GridBlock::Kind::deformable;
    case BodyKind::rigid:
      return GridBlock::Kind::rigid;
  }
  VAT_CHECK(false);
}

}  // namespace

std::size_t default_key_interval(std::size_t particles) {
  return std::clamp(kParticlesBetweenKeys / std::max<std::size_t>(particles, 1), kMinKeyInterval,
                    kMaxKeyInterval);
}

Status FrameRecorder::read(std::span<const std::uint8_t> frame, std::size_t number) {
  const Result<const GridFrame*> decoded = decoder_.decode(frame);
  if (!decoded) return decoded.errors();
  since_key_ = is_key_frame(frame) ? 0 : since_key_ + 1;
  std::swap(before_, frame_);
  frame_ = *decoded.value();
  epoch_ = frame_.header.epoch;
  count_ = number + 1;
  return {};
}

bool FrameRecorder::have_bodies_changed() const {
  const std::size_t vats = state_.has_vat ? 1 : 0;
  if (frame_.blocks.size() != state_.bodies.size() + vats) return true;
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    const PublishedState::Body& body = state_.bodies[b];
    const GridBlock& block = frame_.blocks[b + vats];
    if (block.body != body.id || block.kind != grid_kind(body.kind)) return true;
  }
  return false;
}

bool FrameRecorder::is_key_due(const Simulation& simulation, bool begins_description) const {
  const std::size_t interval =
      settings_.key_every.value_or(default_key_interval(simulation.particle_count()));
  return begins_description || since_key_ + 1 >= interval || !fits_grid(frame_.scale.grid, state_);
}

// The grid remains if possible, because resting particles would otherwise flicker.
FrameScale FrameRecorder::next_scale(const Simulation& simulation) const {
  FrameDomain domain(simulation.scene().vat);
  domain.include(state_);
  const FrameGrid grid =
      domain.centered_grid(settings_.max_error.value_or(default_max_error(simulation)));
  const FrameGrid& last = frame_.scale.grid;
  const bool remains = count_ > 0 && last.quantum <= grid.quantum && fits_grid(last, state_);
  return {remains ? last : grid, {}};
}

FrameRecorder::Parts FrameRecorder::record(const Simulation& simulation) {
  publisher_.publish(simulation, {}, state_);
  const bool begins_description = count_ == 0 || have_bodies_changed();
  const bool is_key = is_key_due(simulation, begins_description);
  Parts parts;
  if (begins_description) {
    ++epoch_;
    parts.description = describe(simulation);
  }
  state_.header.playing = true;
  state_.header.epoch = epoch_;
  state_.header.number = static_cast<std::uint32_t>(count_ + 1);
  state_.header.tick = count_;
  state_.header.published = state_.header.time;
  state_.header.real_time_factor = 1;
  const FrameScale scale = is_key ? next_scale(simulation) : frame_.scale;
  GridFrame next;
  make_grid_frame(state_, scale, next);
  FrameReferences references;
  if (!is_key) references = {&frame_, since_key_ > 0 ? &before_ : nullptr};
  parts.frame = encoder_.encode(next, references);
  before_ = std::exchange(frame_, std::move(next));
  since_key_ = is_key ? 0 : since_key_ + 1;
  ++count_;
  return parts;
}

std::string FrameRecorder::describe(const Simulation& simulation) const {
  const Scene& scene = simulation.scene();
  return Json{{"program", VAT_VERSION},
              {"instruction_set", to_string(simulation.instruction_set())},
              {"epoch", epoch_},
              {"scene", split_level(scene.name).scene},
              {"level", to_string(split_level(scene.name).level)},
              {"title", scene.title},
              {"tick_seconds", settings_.frame_seconds},
              {"gravity", to_json(scene.gravity)},
              {"vat", describe_vat(scene.vat)},
              {"materials", describe_materials(scene)},
              {"bodies", describe_bodies(simulation)}}
      .dump();
}

}  // namespace vat
