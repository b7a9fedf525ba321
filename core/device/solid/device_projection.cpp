#include "core/device/solid/device_projection.h"

#include <algorithm>
#include <span>

#include "core/contact/projection/contact_constraint.h"
#include "core/device/common/kernel_values.h"
#include "core/laws/vat_motion.h"
#include "core/limits.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

constexpr int kMaxRounds = 4;
constexpr std::size_t kMaxSweepers = 1024;  // work-items of sweeps
constexpr std::size_t kNumber = sizeof(std::int32_t);
constexpr std::size_t kVectorColumn = 3 * sizeof(double);

// Structs of projection.cl.
struct ProjectedLaw {
  double threshold, friction, restitution;
  std::int32_t is_projected, padding;
};
constexpr std::size_t kConstraint = 520;
constexpr std::size_t kRigidMotion = 16 * sizeof(double);

std::size_t at_least_one_of(std::size_t count) {
  return std::max<std::size_t>(1, count);
}

std::size_t capacity_for(const Model& model) {
  return std::min<std::size_t>(kMaxProjections, 8 * SolidRange(model).count + 1024);
}

/// The laws in the order of SolidTables::laws. No contact within a body is projected.
std::vector<ProjectedLaw> projected_laws(const Model& model) {
  std::vector<ProjectedLaw> laws;
  const auto add = [&](const ContactLaw& law) {
    laws.push_back(
        {law.threshold, law.friction, law.restitution, std::int32_t{law.is_projected}, 0});
  };
  std::ranges::for_each(model.contact_laws, add);
  laws.resize(laws.size() + model.scene.materials.size(), ProjectedLaw{});
  std::ranges::for_each(model.wall_laws, add);
  return laws;
}

VatMotion motion_of_vat(const Model& model, Real time) {
  return model.scene.vat ? vat_motion(*model.scene.vat, time) : VatMotion{};
}

std::size_t ends_of(const Model& model) {
  return SolidRange(model).free + model.rigid_bodies.size();
}

}  // namespace

DeviceProjection::DeviceProjection(Program& program, const Model& model)
    : program_(program),
      first_(SolidRange(model).first),
      free_(SolidRange(model).free),
      particles_(SolidRange(model).count),
      bodies_(model.rigid_bodies.size()),
      capacity_(capacity_for(model)),
      sums_(program, particles_),
      laws_(program, projected_laws(model).size() * sizeof(ProjectedLaw)),
      counts_(program, particles_ * kNumber),
      begins_(program, (particles_ + 1) * kNumber),
      contacts_(program, capacity_ * kConstraint),
      records_(program, capacity_ * sizeof(Record)),
      saved_records_(program, capacity_ * sizeof(Record)),
      progress_(program, sizeof(Progress)),
      start_position_(program, particles_ * kVectorColumn),
      start_poses_(program, at_least_one_of(bodies_) * DeviceRigidBodies::kPoseBytes),
      motions_(program, at_least_one_of(bodies_) * kRigidMotion),
      predicted_motions_(program, at_least_one_of(bodies_) * kRigidMotion),
      parents_(program, ends_of(model) * kNumber),
      island_of_(program, ends_of(model) * kNumber),
      is_hit_(program, ends_of(model) * kNumber),
      island_begins_(program, (capacity_ + 2) * kNumber),
      members_(program, capacity_ * kNumber) {
  VAT_CHECK(model.has_projection);
  const std::vector<ProjectedLaw> laws = projected_laws(model);
  program.write(laws_, std::span<const ProjectedLaw>(laws));
  program.fill_with_zeros(progress_, sizeof(Progress));
}

std::size_t DeviceProjection::bytes_for(const Model& model) {
  const std::size_t particles = SolidRange(model).count;
  const std::size_t capacity = capacity_for(model);
  return DevicePrefixSums::bytes_for(particles) +
         projected_laws(model).size() * sizeof(ProjectedLaw) + (2 * particles + 1) * kNumber +
         capacity * (kConstraint + 2 * sizeof(Record) + 2 * kNumber) + sizeof(Progress) +
         particles * kVectorColumn + 3 * ends_of(model) * kNumber + 2 * kNumber +
         at_least_one_of(model.rigid_bodies.size()) *
             (DeviceRigidBodies::kPoseBytes + 2 * kRigidMotion);
}

DeviceProjection::Progress DeviceProjection::read_progress() {
  Progress progress{};
  program_.read(progress_, std::span(&progress, 1));
  return progress;
}

void DeviceProjection::write(const Configuration& from) {
  VAT_CHECK(from.contacts.size() <= capacity_);
  read_records_.clear();
  for (const ContactImpulse& contact : from.contacts) {
    Record& record = read_records_.emplace_back();
    store(contact.drift, record.drift);
    store(contact.finish, record.finish);
    record.particle = number_of(contact.particle - first_);
    const std::uint64_t shift = contact.other < std::uint64_t{kWallCount} ? 0 : first_;
    record.other = number_of(contact.other - shift);
    record.is_steady = contact.is_steady ? 1 : 0;
    record.is_present = 1;
  }
  Progress progress{};
  progress.recorded = number_of(read_records_.size());
  program_.write(progress_, std::span<const Progress>(&progress, 1));
  if (!read_records_.empty()) program_.write(records_, std::span<const Record>(read_records_));
}

void DeviceProjection::read() {
  read_records_.resize(static_cast<std::size_t>(read_progress().recorded));
  if (!read_records_.empty()) program_.read(records_, std::span<Record>(read_records_));
}

void DeviceProjection::copy_to(Configuration& to) const {
  to.contacts.clear();
  for (const Record& record : read_records_) {
    if (!record.is_present) continue;
    const std::uint64_t shift = record.other < kWallCount ? 0 : first_;
    to.contacts.push_back({static_cast<Index>(record.particle) + static_cast<Index>(first_),
                           static_cast<std::uint64_t>(record.other) + shift, Vec3(record.drift),
                           Vec3(record.finish), record.is_steady != 0});
  }
}

void DeviceProjection::save() {
  Progress progress = read_progress();
  saved_count_ = static_cast<std::size_t>(progress.recorded);
  progress.all_iterations = 0;
  program_.write(progress_, std::span<const Progress>(&progress, 1));
  if (saved_count_ > 0) program_.copy(records_, saved_records_, saved_count_ * sizeof(Record));
}

void DeviceProjection::restore() {
  Progress progress{};
  progress.recorded = number_of(saved_count_);
  program_.write(progress_, std::span<const Progress>(&progress, 1));
  if (saved_count_ > 0) program_.copy(saved_records_, records_, saved_count_ * sizeof(Record));
}

void DeviceProjection::count(AdvanceReport& report) {
  report.iterations.contacts += read_progress().all_iterations;
}

DeviceProjection::Step DeviceProjection::step_of(const Model& model, Real time, Real dt,
                                                 bool is_finish) const {
  Step step{};
  step.dt = dt;
  step.margin = kContactMargin;
  step.reach = model.contact_reach;
  // The rebound that gravity causes in two steps counts as rest.
  step.slow = model.scene.forces.gravity ? 2 * dt * model.scene.gravity.norm() : 0;
  const VatMotion motion = motion_of_vat(model, time);
  store(motion.offset, step.vat_offset);
  store(motion.velocity, step.wall_velocity);
  step.capacity = number_of(capacity_);
  step.is_finish = is_finish ? 1 : 0;
  return step;
}

void DeviceProjection::predict(const SolidParameters& p, Real dt, const ProjectedSolids& s,
                               const Buffer& counters) {
  if (free_ > 0) {
    program_.run("predict_particles", free_, number_of(free_), dt, start_position_,
                 s.motion.velocity, s.motion.position);
  }
  if (bodies_ == 0) return;
  program_.run("predict_bodies", bodies_, number_of(bodies_), dt, s.rigid.rigid, start_poses_,
               s.rigid.poses, motions_, predicted_motions_, s.rigid.speeds(), s.rigid.spins);
  // Only the end of a step must be within the walls.
  SolidParameters anywhere = p;
  anywhere.walls = 0;
  s.rigid.pose(anywhere, s.motion.position, s.predicted, counters);
}

std::size_t DeviceProjection::find(const SolidParameters& p, const Step& step,
                                   const ProjectedSolids& s, const Buffer& counters) {
  s.cells.clear();
  program_.run("enter_solid_cells", particles_, p, s.motion.position, s.cells.cell_of, s.cells.rank,
               s.cells.counts);
  s.cells.sort();
  program_.run("collect_solids", particles_, p, s.cells.cell_of, s.cells.begins, s.cells.unsorted,
               s.motion.position, s.tables.body_of, s.order, s.sorted);
  for (const std::int32_t is_writing : {0, 1}) {
    program_.run("find_projections", particles_, p, step, is_writing, s.cells.begins, s.order,
                 s.sorted, s.tables.mobility, s.tables.radius, s.tables.body_of, s.tables.bodies,
                 laws_, s.rigid.rigid_of, s.rigid.rigid, begins_, counts_, contacts_);
    if (is_writing == 0) sums_.sum(counts_, begins_);
  }
  program_.run("begin_projections", 1, number_of(particles_), number_of(capacity_), begins_,
               progress_, counters);
  return static_cast<std::size_t>(read_progress().count);
}

void DeviceProjection::set_geometry(const SolidParameters& p, const Step& step,
                                    const ProjectedSolids& s, const Buffer& position,
                                    const Buffer& poses) {
  if (bodies_ > 0) {
    program_.run("find_motions", bodies_, number_of(bodies_), s.rigid.rigid, poses, motions_,
                 predicted_motions_);
  }
  program_.run("set_contact_geometry", count_, p, step, progress_, position, s.motion.position,
               s.motion.velocity, s.tables.mobility, s.tables.radius, s.rigid.rigid_of,
               s.rigid.rigid, poses, motions_, records_, contacts_);
}

void DeviceProjection::find_islands() {
  const std::size_t ends = free_ + bodies_;
  program_.run("reset_islands", ends, number_of(ends), parents_, island_of_);
  program_.run("find_islands", 1, number_of(free_), progress_, contacts_, parents_, island_of_,
               island_begins_, members_);
}

void DeviceProjection::sweep(const Step& step, bool is_first, const ProjectedSolids& s) {
  program_.run("sweep_islands", std::min(count_, kMaxSweepers), step, std::int32_t{is_first},
               progress_, island_begins_, members_, contacts_, s.motion.velocity, motions_,
               s.rigid.poses);
}

void DeviceProjection::drift(const Model& model, const SolidParameters& p, Real start, Real dt,
                             const ProjectedSolids& s, const Buffer& counters) {
  program_.copy(s.motion.position, start_position_, particles_ * kVectorColumn);
  if (bodies_ > 0) {
    program_.copy(s.rigid.poses, start_poses_, bodies_ * DeviceRigidBodies::kPoseBytes);
  }
  predict(p, dt, s, counters);
  const Step end = step_of(model, start + dt, dt, false);
  count_ = find(p, end, s, counters);
  if (count_ == 0) return;
  // Sticking contacts move as far as the wall.
  Step moving = step_of(model, start, dt, false);
  for (int k = 0; k < 3; ++k) {
    moving.wall_velocity[k] = (end.vat_offset[k] - moving.vat_offset[k]) / dt;
  }
  set_geometry(p, moving, s, start_position_, start_poses_);
  find_islands();
  for (int round = 0; round < kMaxRounds; ++round) {
    program_.run("set_late_places", count_, p, end, progress_, start_position_, s.motion.position,
                 s.rigid.poses, predicted_motions_, contacts_);
    sweep(moving, round == 0, s);
    predict(p, dt, s, counters);
    program_.run("check_gaps", count_, p, end, progress_, s.motion.position, contacts_);
    program_.run("end_round", 1, progress_, counters);
    const Progress progress = read_progress();
    if (progress.unsolved != 0 || progress.unmet == 0) break;
    program_.run("clear_round", 1, progress_);
  }
}

void DeviceProjection::finish(const Model& model, const SolidParameters& p, Real end, Real dt,
                              const ProjectedSolids& s, const Buffer& counters) {
  if (count_ > 0) {
    const Step step = step_of(model, end, dt, true);
    set_geometry(p, step, s, s.motion.position, s.rigid.poses);
    find_islands();
    sweep(step, true, s);
    program_.run("end_round", 1, progress_, counters);
  }
  program_.fill_with_zeros(is_hit_, (free_ + bodies_) * kNumber);
  if (count_ > 0) {
    program_.run("find_hits", count_, step_of(model, end, dt, true).slow, number_of(free_),
                 progress_, contacts_, is_hit_);
  }
  program_.run("record_contacts", at_least_one_of(count_), dt, number_of(free_), progress_,
               contacts_, is_hit_, records_);
}

}  // namespace vat
