#include "server/session/core/session_notifier.h"

#include <utility>

#include "core/support/check.h"
#include "protocol/frame/frame_domain.h"
#include "protocol/messages/describe.h"
#include "protocol/scene/level.h"
#include "server/relay/frame_facts.h"
#include "server/session/core/playback.h"

namespace vat {
namespace {

constexpr std::uint16_t kSessionEnded = 1001;

}  // namespace

SessionNotifier::SessionNotifier(const SessionContext& context, const SessionRun& run,
                                 const SessionClock& clock, const SessionHistory& history,
                                 Participants& participants, Participants& recorded)
    : context_(context),
      run_(run),
      clock_(clock),
      history_(history),
      participants_(participants),
      recorded_(recorded),
      frames_(std::make_shared<FrameFeed>(
          context.id, run.simulation().scene().vat, context.environment->metrics,
          context.environment->frame_threads, context.environment->clock)) {
  frames_->set_default_error(default_max_error(run_.simulation()));
}

void SessionNotifier::start_epoch() {
  VAT_CHECK(context_.owner.allows_this_thread());
  description_end_.reset();
  description_due_ = status_due_ = frame_due_ = true;
  participants_.start_epoch(run_.epoch());
  recorded_.start_epoch(run_.epoch());  // the viewers, while a recorded command is executed
  frames_->set_default_error(default_max_error(run_.simulation()));
  for (const auto& [id, watcher] : watchers_) tell_facts(*watcher.outbox, watcher.membership);
}

void SessionNotifier::reset_frames() {
  frames_->set_vat(run_.simulation().scene().vat);
}

void SessionNotifier::tell_facts(ClientOutbox& viewer, std::uint64_t membership) {
  const Simulation& simulation = run_.simulation();
  viewer.start_epoch(membership, run_.epoch());
  viewer.send(write_frame_facts({simulation.scene().vat, default_max_error(simulation)}).dump());
}

void SessionNotifier::watch(const std::shared_ptr<ClientOutbox>& viewer, const Subscription& wanted,
                            SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  const auto [entry, is_new] = watchers_.try_emplace(viewer->id());
  Watcher& watcher = entry->second;
  if (is_new) {
    watcher = {viewer, viewer->join(), {}};
    tell_facts(*viewer, watcher.membership);
  }
  watcher.wanted = wanted;
  frames_->add(viewer, viewer->subscribe(watcher.membership, frames_, now), wanted);
  frame_due_ = true;
}

void SessionNotifier::unwatch(ConnectionId viewer) {
  if (watchers_.erase(viewer) > 0) frames_->remove(viewer);
}

void SessionNotifier::end_watchers() {
  for (const auto& [id, watcher] : watchers_) {
    watcher.outbox->close(kSessionEnded, "the session has ended here");
  }
  watchers_.clear();
}

bool SessionNotifier::is_watched(std::optional<std::uint64_t> tick) const {
  if (!watchers_.empty()) return true;
  return tick ? participants_.is_watched(*tick) : participants_.is_watched();
}

ByAttribute<bool> SessionNotifier::wanted_attributes() const {
  ByAttribute<bool> wanted = participants_.wanted_attributes();
  for (const auto& [id, watcher] : watchers_) {
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      wanted[a] = wanted[a] || watcher.wanted.attribute_errors[a] > 0;
    }
  }
  return wanted;
}

void SessionNotifier::subscribe(Participant& participant, const Subscription& subscription,
                                SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  VAT_CHECK(participant.is_here());
  const std::uint64_t number = participant.outbox->subscribe(participant.membership, frames_, now);
  if (number == 0) return;  // the client has left; its leave is in the inbox
  participant.subscription = subscription;
  participants_.touch();
  const bool replaced = frames_->add(participant.outbox, number, subscription);
  (clock_.playing() && !replaced ? tick_frame_due_ : frame_due_) = true;
}

void SessionNotifier::unsubscribe(Participant& participant) {
  if (!participant.subscription) return;
  VAT_CHECK(participant.is_here());
  participant.subscription.reset();
  participants_.touch();
  participant.outbox->unsubscribe();
  frames_->remove(participant.outbox->id());
}

void SessionNotifier::prepare_tick() {
  constexpr auto kAcceleration = static_cast<std::size_t>(FrameAttribute::acceleration);
  if (wanted_attributes()[kAcceleration]) {
    publisher_.remember(run_.simulation(), run_.tick_seconds());
  } else {
    publisher_.forget();
  }
}

void SessionNotifier::tell_guard(const AdvanceReport& report) {
  for (const GuardEvent& event : report.events) {
    const std::string text = write_event("session.guard", describe_guard(event, run_.tick()));
    participants_.send_event(text);
    recorded_.send_event(text);  // as in start_epoch()
  }
}

void SessionNotifier::tell_device(const Error& error) {
  const std::string text = write_event("session.device", {{"tick", run_.tick()},
                                                          {"code", error.code},
                                                          {"path", error.path},
                                                          {"message", error.message}});
  participants_.send_event(text);
  recorded_.send_event(text);  // as in start_epoch()
}

void SessionNotifier::tell_description() {
  if (!description_due_) return;
  const DescriptionText text = description();
  std::string event = begin_event("session.description") + text.begin;
  event.append(*text.end, 0, text.end->size() - 1);  // a reply has one more object around it
  participants_.send_event(std::move(event));
  description_due_ = false;  // stays due if the above throws
}

void SessionNotifier::tell_divergence() {
  if (!std::exchange(divergence_due_, false) || !history_.divergence()) return;
  const Divergence& divergence = *history_.divergence();
  participants_.send_event(write_event("session.diverged", {{"position", divergence.position},
                                                            {"tick", divergence.tick},
                                                            {"reason", divergence.reason}}));
}

void SessionNotifier::publish_tick() {
  VAT_CHECK(context_.owner.allows_this_thread());
  tell_description();  // a tick may start an epoch
  if (frame_due_ || tick_frame_due_ || is_watched(run_.tick())) publish_frame();
}

void SessionNotifier::announce() {
  VAT_CHECK(context_.owner.allows_this_thread());
  tell_description();
  tell_divergence();
  if (status_due_) {
    announce_status();
    status_due_ = false;
  }
  if (frame_due_) publish_frame();
}

void SessionNotifier::announce_status() {
  if (participants_.connected() == 0) return;
  participants_.send_event(write_event("session.status", status()));
}

void SessionNotifier::tell_presence(SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  Json changes = presence_.take_changes(participants_, now);
  if (changes.is_null()) return;
  participants_.send_event(write_event("presence.changed", std::move(changes)));
}

void SessionNotifier::publish_frame() {
  frame_due_ = tick_frame_due_ = false;
  if (!is_watched({})) return;
  fill_state();
  frames_->publish(state_);
}

void SessionNotifier::fill_state() {
  publisher_.publish(run_.simulation(), wanted_attributes(), state_);
  FrameHeader& header = state_.header;
  header.playing = clock_.playing();
  header.slow = clock_.is_slow();
  header.epoch = run_.epoch();
  header.tick = run_.tick();
  header.published = context_.environment->clock.wall_time();
  header.real_time_factor = static_cast<float>(clock_.rate());
}

Json SessionNotifier::status() const {
  Json status{
      {"tick", run_.tick()},
      {"time", run_.simulation().time()},
      {"playing", clock_.playing()},
      {"speed", clock_.speed()},
      {"real_time_factor", clock_.rate()},
      {"clients", participants_.connected()},
      {"particles", run_.simulation().particle_count()},
  };
  if (context_.playback != nullptr) status["position"] = run_.position();
  const std::span<const GovernorPoint> points = history_.governor_points();
  if (const auto point = find_point(points, run_.simulation().scene())) {
    status["governor"] = {{"point", *point}, {"error", points[*point].error}};
  }
  return status;
}

SessionNotifier::DescriptionText SessionNotifier::description() {
  VAT_CHECK(context_.owner.allows_this_thread());
  if (description_end_ == nullptr) {
    description_end_ = std::make_shared<const std::string>(
        to_message_text(describe_bodies(run_.simulation())) + "}}}");
  }
  return {begin_object(describe_session(), "bodies"), description_end_};
}

Json SessionNotifier::describe_session() const {
  const Scene& scene = run_.simulation().scene();
  Json description{
      {"session", context_.id},
      {"epoch", run_.epoch()},
      {"tick", run_.tick()},
      {"name", context_.settings.name},
      {"scene", split_level(scene.name).scene},
      {"level", to_string(split_level(scene.name).level)},
      {"title", scene.title},
      {"playing", clock_.playing()},
      {"speed", clock_.speed()},
      {"tick_seconds", run_.tick_seconds()},
      {"gravity", to_json(scene.gravity)},
      {"vat", describe_vat(scene.vat)},
      {"materials", describe_materials(scene)},
  };
  if (context_.playback != nullptr) {
    const Playback::Range range = context_.playback->range();
    description["replay"] = {
        {"begin", range.begin}, {"end", range.end}, {"position", run_.position()}};
  }
  return description;
}

SessionSummary SessionNotifier::summary() {
  if (people_ == nullptr || people_changes_ != participants_.changes()) list_people();
  return {context_.settings.name,
          std::string(split_level(run_.simulation().scene().name).scene),
          participants_.connected(),
          clock_.playing(),
          run_.tick(),
          run_.simulation().particle_count(),
          context_.settings.creator,
          context_.playback != nullptr,
          false,
          {},
          people_,
          context_.playback == nullptr ? 0 : context_.playback->cached_bytes()};
}

void SessionNotifier::list_people() {
  auto people = std::make_shared<std::vector<PersonSummary>>();
  for (const auto& [number, participant] : participants_.all()) {
    people->push_back({number, participant.name, participant.role,
                       participant.is_here() ? participant.outbox->address() : ""});
  }
  people_ = std::move(people);
  people_changes_ = participants_.changes();
}

}  // namespace vat
