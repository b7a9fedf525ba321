#include "core/contact/projection/contact_row.h"

#include <algorithm>
#include <cmath>

namespace vat {
namespace {

/// The impulse before the projection, in parts along and perpendicular to the normal.
struct Wanted {
  Real push;
  Vec3 across;
  Real size;  ///< of across

  Wanted(const ContactRow& row, const Vec3& slip) {
    const Vec3 impulse = row.multiplier - row.weight * (slip + row.lift * row.normal);
    push = impulse.dot(row.normal);
    across = impulse - push * row.normal;
    size = across.norm();
  }
};

}  // namespace

Vec3 impulse_at(const ContactRow& row, const Vec3& slip) {
  const Wanted wanted(row, slip);
  const Real mu = row.friction;
  if (row.has_limit) {
    const Real share = wanted.size > row.limit ? row.limit / wanted.size : 1;
    return std::max(Real{0}, wanted.push) * row.normal + share * wanted.across;
  }
  if (wanted.size <= mu * wanted.push) return wanted.push * row.normal + wanted.across;
  if (mu * wanted.size <= -wanted.push) return Vec3::Zero();
  const Real push = (wanted.push + mu * wanted.size) / (1 + mu * mu);
  return push * (row.normal + (mu > 0 ? mu / wanted.size : 0) * wanted.across);
}

Mat3 slope_at(const ContactRow& row, const Vec3& slip) {
  const Wanted wanted(row, slip);
  const Real mu = row.friction;
  const Mat3 along = row.normal * row.normal.transpose();
  Vec3 direction = Vec3::Zero();
  if (wanted.size > 0) direction = wanted.across / wanted.size;
  const Vec3 third = row.normal.cross(direction);
  if (row.has_limit) {
    const Mat3 slope = wanted.push > 0 ? along : Mat3(Mat3::Zero());
    if (wanted.size <= row.limit) return row.weight * (slope + Mat3::Identity() - along);
    return row.weight * (slope + (row.limit / wanted.size) * third * third.transpose());
  }
  if (wanted.size <= mu * wanted.push) return row.weight * Mat3::Identity();
  if (mu * wanted.size <= -wanted.push) return Mat3::Zero();
  if (mu == 0) return row.weight * along;
  const Vec3 edge = row.normal + mu * direction;
  const Real share = 1 / (1 + mu * mu);
  const Real turning = mu * share * (wanted.push + mu * wanted.size) / wanted.size;
  return row.weight * (share * edge * edge.transpose() + turning * third * third.transpose());
}

Real update(ContactRow& row) {
  const Vec3 impulse = impulse_at(row, row.slip);
  // The multiplier changes by its weight times the violation of the constraint.
  Real violation = (impulse - row.multiplier).norm() / row.weight;
  row.multiplier = impulse;
  if (row.has_limit) {
    row.limit = row.friction * std::max(Real{0}, impulse.dot(row.normal));
    return violation;
  }
  const Vec3 across = row.slip - row.slip.dot(row.normal) * row.normal;
  const Real lift = row.friction * across.norm();
  violation += std::abs(lift - row.lift);
  row.lift = lift;
  return violation;
}

}  // namespace vat
