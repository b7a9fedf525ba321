#include "core/contact/self_contact_list.h"

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

#include "core/stage/context.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The skin in reaches, in addition to the slack.
constexpr Real kSelfSkinShare = 0.6;

}  // namespace

// The rotation closest to the motion of the particles, by the singular values of their covariance
// (W. Kabsch, Acta Cryst. A 32 (1976) 922).
void SelfContactList::fit(const std::vector<Vec3>& positions) {
  VAT_CHECK(built_at_.size() == particles_.size());
  from_.setZero();
  to_.setZero();
  for (Index k = 0; k < particles_.size(); ++k) {
    from_ += built_at_[k];
    to_ += positions[particles_.begin + k];
  }
  from_ /= particles_.size();
  to_ /= particles_.size();
  Mat3 covariance = Mat3::Zero();
  for (Index k = 0; k < particles_.size(); ++k) {
    covariance += (positions[particles_.begin + k] - to_) * (built_at_[k] - from_).transpose();
  }
  turn_.setIdentity();
  if (!covariance.allFinite()) return;
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 left = svd.matrixU();
  if (left.determinant() * svd.matrixV().determinant() < 0) left.col(2) *= -1;
  turn_ = left * svd.matrixV().transpose();
}

bool SelfContactList::is_within(const StepContext& c, Real distance) {
  is_far_.assign(block_count(particles_.size()), 0);
  for_blocks(c.runner, particles_.size(), [&](std::size_t begin, std::size_t end) {
    bool is_far = false;
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 way =
          c.configuration.position[particles_.begin + k] - to_ - turn_ * (built_at_[k] - from_);
      is_far |= !(way.squaredNorm() <= distance * distance);  // a NaN counts as far
    }
    is_far_[begin / kBlockSize] = is_far ? 1 : 0;
  });
  return std::ranges::find(is_far_, 1) == is_far_.end();
}

bool SelfContactList::is_current(const StepContext& c, Real slack) {
  if (!(slack < skin_)) return false;
  const Real allowed = (skin_ - slack) / 2;
  if (is_within(c, allowed)) return true;
  fit(c.configuration.position);
  return is_within(c, allowed);
}

bool SelfContactList::update(const StepContext& c, Real slack) {
  if (is_current(c, slack)) return false;
  const Real skin = slack + kSelfSkinShare * c.model.contact_reach;
  skin_ = 0;  // until the list is complete: memory may be insufficient
  search(c, skin);
  skin_ = skin;
  return true;
}

void SelfContactList::search(const StepContext& c, Real skin) {
  all_.resize(particles_.size());
  std::iota(all_.begin(), all_.end(), particles_.begin);
  const std::vector<Vec3>& positions = c.configuration.position;
  built_at_.assign(positions.begin() + particles_.begin, positions.begin() + particles_.end);
  turn_.setIdentity();
  from_ = to_ = Vec3::Zero();
  sorted_.build(c.model, positions, all_, c.model.contact_reach + skin);
  table_.fill(c.runner, particles_.size(), [&](Index k, std::vector<Index>& found) {
    ContactSearch(c.model, c.configuration, particles_.begin + k, skin)
        .look_in(
            sorted_, [](Index) { return true; }, [&](Index slot) { return sorted_.particle[slot]; },
            [&](Index j) { found.push_back(j); });
  });
}

}  // namespace vat
