#include "core/device/solid/device_spring_changes.h"

#include <cmath>
#include <limits>
#include <span>

#include "core/device/common/kernel_values.h"
#include "core/device/contact/solid_geometry.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

/// The struct SpringChange of spring_changes.cl.
struct SpringChange {
  double yield_strain, hardening, most_strain, share, greatest_stretch;
  std::int32_t flows;
  std::int32_t padding;
};

SpringChange change_of(const Material& material, Real dt) {
  SpringChange change{};
  change.greatest_stretch = material.tearing_strain ? 1 + *material.tearing_strain
                                                    : std::numeric_limits<double>::infinity();
  if (!material.plasticity) return change;
  const Plasticity& plasticity = *material.plasticity;
  change.yield_strain = plasticity.yield_strain;
  change.hardening = plasticity.hardening;
  change.most_strain = plasticity.max_strain;
  change.share = plasticity.relaxation_time > 0 ? -std::expm1(-dt / plasticity.relaxation_time) : 1;
  change.flows = 1;
  return change;
}

}  // namespace

DeviceSpringChanges::DeviceSpringChanges(Program& program, const Model& model)
    : program_(program),
      count_(model.spring_ends.size()),
      free_(SolidRange(model).free),
      ends_(springs_on_device(model)),
      starts_(program, count_ * sizeof(double)),
      changes_(program, model.scene.materials.size() * sizeof(SpringChange)),
      are_torn_(program, count_ * sizeof(std::int32_t)),
      saved_are_torn_(program, count_ * sizeof(std::int32_t)),
      saved_springs_(program, count_ * sizeof(SpringEnd)) {
  VAT_CHECK(model.springs_change && count_ > 0);
  std::vector<double> starts;
  for (const SpringEnd& end : ends_) starts.push_back(end.rest_length);
  program.write(starts_, std::span<const double>(starts));
  std::vector<SpringChange> changes;
  for (const Material& material : model.scene.materials) {
    changes.push_back(change_of(material, model.scene.numerics.step));
  }
  program.write(changes_, std::span<const SpringChange>(changes));
}

std::size_t DeviceSpringChanges::bytes_for(const Model& model) {
  return model.spring_ends.size() *
             (sizeof(double) + 2 * sizeof(std::int32_t) + sizeof(SpringEnd)) +
         model.scene.materials.size() * sizeof(SpringChange);
}

void DeviceSpringChanges::write(const Model& model, const Configuration& from,
                                const SolidTables& tables) {
  VAT_CHECK(from.springs.size() == count_ && model.spring_ends.size() == count_);
  std::vector<SpringEnd> springs = ends_;
  std::vector<std::int32_t> torn;
  for (std::size_t s = 0; s < count_; ++s) {
    const SpringState& state = from.springs[s];
    springs[s].rest_length = state.rest_length;
    if (state.is_torn) springs[s].stiffness = springs[s].damping = 0;
    torn.push_back(state.is_torn ? 1 : 0);
  }
  program_.write(tables.springs, std::span<const SpringEnd>(springs));
  program_.write(are_torn_, std::span<const std::int32_t>(torn));
}

void DeviceSpringChanges::read(const SolidTables& tables) {
  springs_.resize(count_);
  torn_.resize(count_);
  program_.read(tables.springs, std::span<SpringEnd>(springs_));
  program_.read(are_torn_, std::span<std::int32_t>(torn_));
}

void DeviceSpringChanges::copy_to(Configuration& to) const {
  VAT_CHECK(to.springs.size() == count_ && springs_.size() == count_);
  for (std::size_t s = 0; s < count_; ++s) {
    to.springs[s] = {springs_[s].rest_length, torn_[s] != 0};
  }
}

void DeviceSpringChanges::save(const SolidTables& tables) {
  program_.copy(are_torn_, saved_are_torn_, count_ * sizeof(std::int32_t));
  program_.copy(tables.springs, saved_springs_, count_ * sizeof(SpringEnd));
}

void DeviceSpringChanges::restore(const SolidTables& tables) {
  program_.copy(saved_are_torn_, are_torn_, count_ * sizeof(std::int32_t));
  program_.copy(saved_springs_, tables.springs, count_ * sizeof(SpringEnd));
}

void DeviceSpringChanges::change(const opencl::Buffer& position, const SolidTables& tables) {
  program_.run("change_springs", free_, number_of(free_), position, tables.spring_begin, starts_,
               tables.body_of, tables.bodies, changes_, tables.springs, are_torn_);
}

}  // namespace vat
