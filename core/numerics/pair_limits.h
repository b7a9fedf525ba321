#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene/range_check.h"
#include "core/scene/scene.h"

namespace vat {

/// Body of the scene, for the count of pairs.
struct PairBody {
  const BodyDescription* description = nullptr;
  std::span<const Vec3> positions;  ///< [m]
  std::span<const Real> radii;      ///< [m]
};

/// Returns whether every period of the scene is at least twice the distance at which two particles
/// interact. If not, adds errors at `path` (code out_of_range).
bool check_periods(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                   RangeCheck& check);

/// Adds an error at `path` if there are more than max_start_pairs() pairs of neighbours, or if
/// finding them needs more than kMaxSearch tests. Liquid particles interact within the support
/// radius of their material. If bodies can touch, all particles interact within the maximum contact
/// distance of the scene. The periods must be valid.
void check_pairs(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                 RangeCheck& check);
/// Performs check_pairs() after a change of the contact laws only.
void check_contact_pairs(const Scene& scene, const std::vector<PairBody>& bodies,
                         const std::string& path, RangeCheck& check);
/// Performs check_pairs() if only the last body is new.
void check_pairs_of_new(const Scene& scene, const std::vector<PairBody>& bodies,
                        const std::string& path, RangeCheck& check);
/// Performs check_pairs() after a move of one body. Pairs are counted only if other bodies are near
/// the moved body.
void check_pairs_of_moved(const Scene& scene, const std::vector<PairBody>& bodies, std::size_t body,
                          const std::string& path, RangeCheck& check);

}  // namespace vat
