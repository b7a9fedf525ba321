#include "server/session/session_core.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <utility>

#include "server/session/describe.h"

namespace vat {
namespace {

double wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace

SessionCore::SessionCore(std::string id, std::string name, Simulation simulation,
                         const SessionEnvironment& environment)
    : id_(std::move(id)),
      name_(std::move(name)),
      environment_(environment),
      run_(std::move(simulation), environment.metrics),
      frames_(std::make_shared<FrameFeed>(id_, run_.simulation().scene().vat, environment.metrics,
                                          environment.frame_threads)) {}

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

void SessionCore::load(Simulation simulation) {
  run_.load(std::move(simulation));
  members_.forget_grabs();
  interrupt();
  rate_ = {};
  frames_->set_vat(run_.simulation().scene().vat);
  start_epoch();
}

void SessionCore::reset() {
  run_.reset();
  members_.forget_grabs();
  interrupt();
  frames_->set_vat(run_.simulation().scene().vat);
  start_epoch();
}

void SessionCore::bodies_changed() {
  run_.start_epoch();
  start_epoch();
}

void SessionCore::start_epoch() {
  description_due_ = status_due_ = frame_due_ = true;
  members_.start_epoch(run_.epoch());
}

void SessionCore::interrupt() {
  interrupted_ = true;
}

bool SessionCore::take_interruption() {
  return std::exchange(interrupted_, false);
}

Member& SessionCore::join(std::shared_ptr<ClientOutbox> outbox, std::uint64_t membership) {
  leave(outbox->id());
  status_due_ = true;
  outbox->start_epoch(membership, run_.epoch());
  return members_.add(std::move(outbox), membership);
}

void SessionCore::subscribe(Member& member, const Subscription& subscription,
                            SteadyClock::time_point now) {
  const std::uint64_t number = member.outbox->subscribe(member.membership, frames_, now);
  if (number == 0) return;  // it is about to leave
  member.subscription = subscription;
  frames_->add(member.outbox, number, subscription);
  frame_due_ = true;
}

void SessionCore::unsubscribe(Member& member) {
  if (!member.subscription) return;
  member.subscription.reset();
  member.outbox->unsubscribe();
  frames_->remove(member.outbox->id());
}

void SessionCore::leave(ConnectionId client) {
  const Member* member = members_.find(client);
  if (member == nullptr) return;
  for (const auto& [grab, body] : member->grabs) {
    const Status ended = run_.simulation().grab_end(grab);
    if (!ended) spdlog::warn("session {}: grab {} was gone already", id_, grab);
  }
  if (member->subscription) frames_->remove(client);
  members_.remove(client);
  status_due_ = true;
}

bool SessionCore::tick(SteadyClock::time_point now, bool timed) {
  const AdvanceReport report = run_.advance();
  tell_guard(report);
  if (report.failed) {
    spdlog::warn("session {}: paused by the guard at tick {}", id_, run_.tick());
    set_playing(false);
    return false;
  }
  for (const std::uint64_t grab : report.ended_grabs) members_.forget_grab(grab);
  if (report.bodies_changed) bodies_changed();
  if (timed) rate_.tick_done(now, run_.tick_seconds());
  return true;
}

void SessionCore::tell_guard(const AdvanceReport& report) {
  for (const GuardEvent& event : report.events) {
    members_.send_event(write_event("session.guard", describe_guard(event, run_.tick())));
  }
}

void SessionCore::tell_description() {
  if (!description_due_) return;
  members_.send_event(write_event("session.description", description()));
  description_due_ = false;  // what fails stays due
}

void SessionCore::publish_tick() {
  tell_description();  // a tick may begin an epoch
  if (frame_due_ || members_.is_watched(run_.tick())) publish_frame();
}

void SessionCore::announce() {
  tell_description();
  if (status_due_) {
    announce_status();
    status_due_ = false;
  }
  if (frame_due_) publish_frame();
}

void SessionCore::announce_status() {
  if (members_.size() > 0) members_.send_event(write_event("session.status", status()));
}

void SessionCore::publish_frame() {
  frame_due_ = false;
  if (members_.is_watched()) frames_->publish(published());
}

PublishedState SessionCore::published() const {
  PublishedState state = publish(run_.simulation(), members_.wanted_attributes());
  state.header.playing = playing_;
  state.header.slow = playing_ && rate_.slower_than(speed_);
  state.header.epoch = run_.epoch();
  state.header.tick = run_.tick();
  state.header.published = wall_clock();
  state.header.real_time_factor = static_cast<float>(rate_.rate());
  return state;
}

void SessionCore::close_silent(SteadyClock::time_point now) {
  members_.close_silent(now, environment_.limits.frame_patience);
}

Json SessionCore::status() const {
  return {
      {"tick", run_.tick()},
      {"time", run_.simulation().time()},
      {"playing", playing_},
      {"speed", speed_},
      {"real_time_factor", rate_.rate()},
      {"clients", members_.size()},
      {"particles", run_.simulation().particle_count()},
  };
}

Json SessionCore::description() const {
  const Scene& scene = run_.simulation().scene();
  return {
      {"session", id_},
      {"epoch", run_.epoch()},
      {"tick", run_.tick()},
      {"name", name_},
      {"scene", scene.name},
      {"title", scene.title},
      {"playing", playing_},
      {"speed", speed_},
      {"tick_seconds", run_.tick_seconds()},
      {"gravity", to_json(scene.gravity)},
      {"vat", describe_vat(scene.vat)},
      {"bodies", describe_bodies(run_.simulation())},
  };
}

SessionSummary SessionCore::summary() const {
  return {name_,       run_.simulation().scene().name,    members_.size(), playing_,
          run_.tick(), run_.simulation().particle_count()};
}

}  // namespace vat
