#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene/range_check.h"
#include "core/scene/scene.h"

namespace vat {

/// A body of the scene for the count of pairs.
struct PairBody {
  const BodyDescription* description = nullptr;
  std::span<const Vec3> positions;  ///< [m]
  std::span<const Real> radii;      ///< [m]
};

/// Whether every period of the scene is at least twice the distance at which any two particles
/// notice each other; adds errors at `path` (code out_of_range).
bool check_periods(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                   RangeCheck& check);

/// Adds an error where particles reach so many others that time and memory are lost on pairs: more
/// than max_start_pairs() of them, or more than kMaxSearch tries to find them. Liquid particles
/// reach others of their material within its support radius; where bodies can touch, all particles
/// reach others within the greatest distance at which any two of the scene do. Errors are at
/// `path`. The periods must be long enough.
void check_pairs(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                 RangeCheck& check);
/// The same where only the way in which bodies touch has changed.
void check_contact_pairs(const Scene& scene, const std::vector<PairBody>& bodies,
                         const std::string& path, RangeCheck& check);
/// The same where only the last of the bodies is new.
void check_pairs_of_new(const Scene& scene, const std::vector<PairBody>& bodies,
                        const std::string& path, RangeCheck& check);
/// The same where only one of the bodies has moved: where nothing is near it now, there are no more
/// pairs than there were.
void check_pairs_of_moved(const Scene& scene, const std::vector<PairBody>& bodies, std::size_t body,
                          const std::string& path, RangeCheck& check);

}  // namespace vat
