#include "server/session/session_core.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "server/session/default_error.h"
#include "server/session/describe.h"
#include "server/session/replay_run.h"

namespace vat {
SessionCore::SessionCore(std::string id, SessionSettings settings, Simulation simulation,
                         const SessionEnvironment& environment)
    : SessionCore(std::move(id), std::move(settings), std::move(simulation),
                  environment.resources.take_anyway({}), environment) {
  run_.resize_share_anyway();
}

SessionCore::SessionCore(std::string id, SessionSettings settings, Simulation simulation,
                         ResourceShare share, const SessionEnvironment& environment)
    : id_(std::move(id)),
      settings_(std::move(settings)),
      environment_(&environment),
      run_(std::move(simulation), std::move(share), environment.metrics),
      frames_(std::make_shared<FrameFeed>(id_, run_.simulation().scene().vat, environment.metrics,
                                          environment.frame_threads, environment.clock)) {
  frames_->set_default_error(default_max_error(run_.simulation()));
}

void SessionCore::set_playing(bool playing) {
  interrupt();
  status_due_ = true;
  if (playing != playing_) rate_ = {};
  if (playing_ && !playing) frame_due_ = true;  // for those who have not got the last state
  playing_ = playing;
}

void SessionCore::set_speed(double speed) {
  speed_ = speed;
  rate_ = {};
  status_due_ = true;
}

void SessionCore::set_clock(bool playing, double speed) {
  playing_ = playing;
  speed_ = speed;
}

void SessionCore::begin_epoch(std::uint32_t epoch) {
  run_.set_epoch(epoch);
  rate_ = {};
  start_epoch();
}

void SessionCore::load(Simulation simulation) {
  run_.load(std::move(simulation));
  begin_anew();
}

void SessionCore::restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick) {
  run_.restore(std::move(simulation), as_loaded, tick);
  begin_anew();
}

void SessionCore::begin_anew() {
  loaded_ = sequence_;
  divergence_.reset();
  participants_.forget_grabs();
  interrupt();
  rate_ = {};
  frames_->set_vat(run_.simulation().scene().vat);
  start_epoch();
}

void SessionCore::reset() {
  divergence_.reset();
  run_.reset();
  participants_.forget_grabs();
  interrupt();
  frames_->set_vat(run_.simulation().scene().vat);
  start_epoch();
}

void SessionCore::bodies_changed() {
  run_.start_epoch();
  start_epoch();
}

void SessionCore::state_changed() {
  publisher_.forget();
  bodies_changed();  // or a session that pauses would show no other frame of its tick
}

void SessionCore::start_epoch() {
  description_due_ = status_due_ = frame_due_ = true;
  participants_.start_epoch(run_.epoch());
  recorded_.start_epoch(run_.epoch());  // those who watch, while the past is carried out
  frames_->set_default_error(default_max_error(run_.simulation()));
}

void SessionCore::interrupt() {
  interrupted_ = true;
}

bool SessionCore::take_interruption() {
  return std::exchange(interrupted_, false);
}

void SessionCore::subscribe(Participant& participant, const Subscription& subscription,
                            SteadyClock::time_point now) {
  const std::uint64_t number = participant.outbox->subscribe(participant.membership, frames_, now);
  if (number == 0) return;  // it is about to leave
  participant.subscription = subscription;
  participants_.touch();
  const bool replaced = frames_->add(participant.outbox, number, subscription);
  (playing_ && !replaced ? tick_frame_due_ : frame_due_) = true;
}

void SessionCore::unsubscribe(Participant& participant) {
  if (!participant.subscription) return;
  participant.subscription.reset();
  participants_.touch();
  participant.outbox->unsubscribe();
  frames_->remove(participant.outbox->id());
}

bool SessionCore::tick(SteadyClock::time_point now, bool timed) {
  constexpr auto kAcceleration = static_cast<std::size_t>(FrameAttribute::acceleration);
  if (participants_.wanted_attributes()[kAcceleration]) {
    publisher_.remember(run_.simulation(), run_.tick_seconds());
  } else {
    publisher_.forget();
  }
  const AdvanceReport report = run_.advance();
  tell_guard(report);
  if (report.failed) {
    spdlog::warn("session {}: paused by the guard at tick {}", id_, run_.tick());
    set_playing(false);
    return false;
  }
  for (const std::uint64_t grab : report.ended_grabs) participants_.forget_grab(grab);
  if (report.bodies_changed) bodies_changed();
  if (timed) rate_.tick_done(now, run_.tick_seconds());
  return true;
}

void SessionCore::tell_guard(const AdvanceReport& report) {
  for (const GuardEvent& event : report.events) {
    const std::string text = write_event("session.guard", describe_guard(event, run_.tick()));
    participants_.send_event(text);
    recorded_.send_event(text);  // the same
  }
}

void SessionCore::tell_description() {
  if (!description_due_) return;
  participants_.send_event(write_event("session.description", description()));
  description_due_ = false;  // what fails stays due
}

void SessionCore::publish_tick() {
  tell_description();  // a tick may begin an epoch
  if (frame_due_ || tick_frame_due_ || participants_.is_watched(run_.tick())) publish_frame();
}

void SessionCore::announce() {
  tell_description();
  tell_divergence();
  if (status_due_) {
    announce_status();
    status_due_ = false;
  }
  if (frame_due_) publish_frame();
}

void SessionCore::announce_status() {
  if (participants_.connected() > 0)
    participants_.send_event(write_event("session.status", status()));
}

void SessionCore::publish_frame() {
  frame_due_ = tick_frame_due_ = false;
  if (!participants_.is_watched()) return;
  fill_state();
  frames_->publish(state_);
}

void SessionCore::fill_state() {
  publisher_.publish(run_.simulation(), participants_.wanted_attributes(), state_);
  FrameHeader& header = state_.header;
  header.playing = playing_;
  header.slow = playing_ && rate_.slower_than(speed_);
  header.epoch = run_.epoch();
  header.tick = run_.tick();
  header.published = environment_->clock.wall_time();
  header.real_time_factor = static_cast<float>(rate_.rate());
}

void SessionCore::close_silent(SteadyClock::time_point now) {
  participants_.close_silent(now, environment_->limits.frame_patience);
}

Json SessionCore::status() const {
  Json status{
      {"tick", run_.tick()},
      {"time", run_.simulation().time()},
      {"playing", playing_},
      {"speed", speed_},
      {"real_time_factor", rate_.rate()},
      {"clients", participants_.connected()},
      {"particles", run_.simulation().particle_count()},
  };
  if (replay_ != nullptr) status["position"] = run_.position();
  return status;
}

Json SessionCore::description() const {
  const Scene& scene = run_.simulation().scene();
  Json description{
      {"session", id_},
      {"epoch", run_.epoch()},
      {"tick", run_.tick()},
      {"name", settings_.name},
      {"scene", scene.name},
      {"title", scene.title},
      {"playing", playing_},
      {"speed", speed_},
      {"tick_seconds", run_.tick_seconds()},
      {"gravity", to_json(scene.gravity)},
      {"vat", describe_vat(scene.vat)},
      {"bodies", describe_bodies(run_.simulation())},
  };
  if (replay_ != nullptr) {
    const Recording& recording = replay_->recording();
    description["replay"] = {
        {"begin", recording.begin}, {"end", recording.end}, {"position", run_.position()}};
  }
  return description;
}

SessionSummary SessionCore::summary() {
  if (people_ == nullptr || people_changes_ != participants_.changes()) list_people();
  return {settings_.name,
          run_.simulation().scene().name,
          participants_.connected(),
          playing_,
          run_.tick(),
          run_.simulation().particle_count(),
          settings_.creator,
          replay_ != nullptr,
          false,
          {},
          people_};
}

void SessionCore::list_people() {
  auto people = std::make_shared<std::vector<PersonSummary>>();
  for (const auto& [number, participant] : participants_.all()) {
    people->push_back({number, participant.name, participant.role,
                       participant.is_here() ? participant.outbox->address() : ""});
  }
  people_ = std::move(people);
  people_changes_ = participants_.changes();
}

}  // namespace vat
