#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/forces/mirrors.h"
#include "core/limits.h"
#include "core/pairs/pair_clusters.h"
#include "core/pairs/pair_sums.h"
#include "core/support/grow.h"

namespace vat {

struct CellSortedPoints;
struct StepContext;

/// What walls, or a world that repeats itself, show of a particle.
struct PairImage {
  Vec3 offset;                 ///< of the image from the particle, once that is turned [m]
  Index source;                ///< the particle
  std::array<bool, 3> axes{};  ///< along which the image is reflected

  Vec3 turn(const Vec3& x) const { return Mirror{axes, {}}.turn(x); }
  Vec3 place(const Vec3& p) const { return offset + turn(p); }
  /// The mirror alone, of an image in walls.
  Mirror mirror() const;
};

/// The same in few bytes: of each axis, which of the offsets that there are along it.
struct PackedImage {
  Index source;
  std::array<std::uint8_t, 3> offsets;
};

/// The offsets of images along each axis.
class ImageOffsets {
 public:
  ImageOffsets() = default;
  ImageOffsets(const Model& model, const VatMotion& motion);

  PackedImage pack(const PairImage& image) const;
  PairImage unpack(const PackedImage& image) const {
    const auto& [x, y, z] = image.offsets;
    return {{offsets_[0][x], offsets_[1][y], offsets_[2][z]},
            image.source,
            {x >= kLowWall, y >= kLowWall, z >= kLowWall}};
  }

 private:
  enum Kind : std::uint8_t { kNone, kBack, kOn, kLowWall, kHighWall, kKinds };

  std::array<std::array<Real, kKinds>, 3> offsets_{};  ///< by axis [m]
};

struct WeightFactors {
  std::array<Real, kMaxMaterials> liquid;  ///< by material
  Real solid = 1;

  WeightFactors() { liquid.fill(1); }
};

/// All that acts in a coupled liquid's sums over pairs: liquid in the order of its cells, solids in
/// theirs; images of solids, and of liquid, in a world that repeats itself; images of solids, and
/// of liquid, in walls; and one more that adds nothing, for padding.
class PairSources {
 public:
  /// From the workspace's sorted points, with images of those within `reach` [m] of walls, and
  /// weights with factors of 1.
  void build(const StepContext& context, Real reach);
  /// Whether build() would find the same places.
  bool is_current(const StepContext& context) const;
  /// Rises with each build().
  std::uint64_t version() const { return version_; }
  /// Weights are rest volumes times the scale of the first liquid's kernel and these factors.
  void set_weights(const StepContext& context, const WeightFactors& factors);

  /// motion(s) of liquid slots, solid(s) of solid slots, and image(image, motion of its source).
  template <class Liquid, class Solid, class Image>
  void set_motions(TaskRunner* runner, Liquid&& liquid, Solid&& solid, Image&& image) {
    resize_closely(motions, count() + 1);
    motions[count()] = {};
    for_blocks(runner, count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        if (n < solids_) {
          motions[n] = liquid(n);
        } else if (n < images_begin_) {
          motions[n] = solid(n - solids_);
        }
      }
    });
    for (const ImageGroup& group : images_) {
      for_blocks(runner, group.count(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
          const PairImage& one = offsets_.unpack(group.image(s));
          motions[group.first + s] = image(one, motions[one.source]);
        }
      });
    }
  }

  /// Without the padding.
  std::size_t count() const { return places.size() - 1; }
  Index first_solid() const { return solids_; }
  Index first_image() const { return images_begin_; }
  /// The particle that an image is of; a particle itself.
  Index source_of(Index n) const;
  /// The first image in a wall; and the first of liquid.
  Index first_mirrored() const { return images_[kMirroredSolids].first; }
  Index first_mirrored_liquid() const { return images_[kMirroredLiquid].first; }
  /// As above; and of them those of liquid.
  std::array<SourceGroup, 6> groups(const UniformGrid& liquid, const UniformGrid& solids) const;
  std::array<SourceGroup, 3> liquid_groups(const UniformGrid& liquid) const;
  const SearchPlaces& search_places() const { return search_; }

  std::vector<PairPlace> places;    ///< by source, and the padding
  std::vector<PairMotion> motions;  ///< the same

 private:
  struct ImageGroup {
    std::vector<PackedImage> all;  ///< in the order of their sources
    UniformGrid grid;
    Index first = 0;  ///< source

    std::size_t count() const { return all.size(); }
    /// That in a slot.
    const PackedImage& image(std::size_t slot) const { return all[grid.order()[slot]]; }
  };
  enum Images : std::uint8_t { kShiftedSolids, kShiftedLiquid, kMirroredSolids, kMirroredLiquid };
  static constexpr std::array kAllImages = {kShiftedSolids, kShiftedLiquid, kMirroredSolids,
                                            kMirroredLiquid};
  SourceGroup group_of(Images which) const { return {&images_[which].grid, images_[which].first}; }
  void find_images(const StepContext& c, Real reach, Images kind);
  void join_images(const StepContext& c, Images kind);
  void set_places(const StepContext& c);
  void set_image_places(Images kind, TaskRunner* runner);
  void set_search_places(TaskRunner* runner);

  Index solids_ = 0;  ///< first source that is a solid
  Index images_begin_ = 0;
  std::array<ImageGroup, 4> images_;
  ImageOffsets offsets_;
  std::vector<std::vector<PackedImage>> found_;  ///< by block of particles
  std::vector<std::size_t> found_begin_;         ///< the same: of its images among all
  std::vector<Vec3> image_points_;               ///< of the group last found
  SearchPlaces search_;
  std::uint64_t version_ = 0;
  std::uint64_t liquid_version_ = 0;
  std::uint64_t solid_version_ = 0;
  Vec3 wall_offset_ = Vec3::Zero();
};

}  // namespace vat
