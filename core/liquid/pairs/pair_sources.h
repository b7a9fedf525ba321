#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/limits.h"
#include "core/liquid/pairs/mirrors.h"
#include "core/liquid/pairs/pair_clusters.h"
#include "core/liquid/pairs/pair_sums.h"
#include "core/support/grow.h"

namespace vat {

struct CellSortedPoints;
struct StepContext;

/// A mirror image of a particle in walls, or a periodic image.
struct PairImage {
  Vec3 offset;                 ///< from the reflected position to the image [m]
  Index source;                ///< index of the particle
  std::array<bool, 3> axes{};  ///< the reflected axes
  /// Sum of 3^axis for reflections at a low wall, and 2 * 3^axis for reflections at a high wall.
  /// Set by ImageOffsets::unpack().
  std::uint8_t walls = 0;

  Vec3 turn(const Vec3& x) const { return Mirror{axes, {}}.turn(x); }
  Vec3 place(const Vec3& p) const { return offset + turn(p); }
  /// Returns the reflection without periodic shifts, for an image in walls.
  Mirror mirror() const;
};

/// A compressed PairImage, with the index of the offset in ImageOffsets for each axis.
struct PackedImage {
  Index source;
  std::array<std::uint8_t, 3> offsets;
};

/// The possible offsets of images along each axis.
class ImageOffsets {
 public:
  ImageOffsets() = default;
  ImageOffsets(const Model& model, const VatMotion& motion);

  PackedImage pack(const PairImage& image) const;
  /// Returns the image of `source` in walls, without periodic shifts.
  static PackedImage in_walls(Index source, std::span<const int> walls) {
    PackedImage packed{source, {}};
    for (const int wall : walls) {
      packed.offsets[static_cast<std::size_t>(wall / 2)] = wall % 2 == 0 ? low_wall : high_wall;
    }
    return packed;
  }
  PairImage unpack(const PackedImage& image) const {
    const auto& [x, y, z] = image.offsets;
    return {{offsets_[0][x], offsets_[1][y], offsets_[2][z]},
            image.source,
            {reflects(x), reflects(y), reflects(z)},
            static_cast<std::uint8_t>(wall_at(x) + 3 * wall_at(y) + 9 * wall_at(z))};
  }
  /// Returns whether an image with the offset `index` is reflected along the offset's axis.
  static bool reflects(std::uint8_t index) { return index >= low_wall; }

 private:
  enum Kind : std::uint8_t { none, back, on, low_wall, high_wall };
  /// Returns 1 for a low wall, 2 for a high wall, and 0 without a reflection.
  static int wall_at(std::uint8_t index) { return reflects(index) ? index - low_wall + 1 : 0; }
  static constexpr std::size_t kKinds = high_wall + 1;

  std::array<std::array<Real, kKinds>, 3> offsets_{};  ///< by axis [m]
};

struct WeightFactors {
  std::array<Real, kMaxMaterials> liquid;  ///< by material
  Real solid = 1;

  WeightFactors() { liquid.fill(1); }
};

/// All sources of the pair sums of coupled liquids (solvers `tait` and `incompressible`). The first
/// sources are the liquid particles and then the solid particles, in the order of their cells. The
/// next sources are the periodic images of solids and of liquid, and the images of solids and of
/// liquid in walls. The last source has no effect and is used as padding.
class PairSources {
 public:
  /// Collects the sorted particles of the workspace, and the images of particles within `reach` [m]
  /// of a wall or periodic boundary. Sets the weights with factors of 1.
  void build(const StepContext& context, Real reach);
  /// Returns whether build() would result in the same positions.
  bool is_current(const StepContext& context) const;
  /// Returns a number that increases with each build().
  std::uint64_t version() const { return version_; }
  /// Sets the weights to rest volume times the scale of the first liquid's kernel times `factors`.
  void set_weights(const StepContext& context, const WeightFactors& factors);

  void make_room_for_motions();
  /// Sets the motion (pressure and velocity) of each source: the result of liquid(slot) for a
  /// liquid slot, of solid(slot) for a solid slot, and of image(i, source_motion) for image i.
  template <class Liquid, class Solid, class Image>
  void set_motions(TaskRunner* runner, Liquid&& liquid, Solid&& solid, Image&& image) {
    make_room_for_motions();
    for_blocks(runner, solids_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) set_motion(s, liquid(s));
    });
    set_other_motions(runner, solid, image);
  }
  /// Sets the motions of solids and images. Must be called after set_motion() for all liquid slots.
  template <class Solid, class Image>
  void set_other_motions(TaskRunner* runner, Solid&& solid, Image&& image) {
    for_blocks(runner, images_begin_ - solids_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) set_motion(solids_ + s, solid(s));
    });
    for (const ImageGroup& group : images_) {
      for_blocks(runner, group.count(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
          const PairImage& one = offsets_.unpack(group.all[s]);
          set_motion(group.first + s, image(one, motion(one.source)));
        }
      });
    }
  }
  /// Sets the motions of solids like set_other_motions(). Images have the turned velocities of
  /// their sources and no pressure.
  template <class Solid>
  void set_turned_motions(TaskRunner* runner, Solid&& solid) {
    for_blocks(runner, images_begin_ - solids_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) set_motion(solids_ + s, solid(s));
    });
    is_single_ ? turn_motions(runner, packed_motions_) : turn_motions(runner, motions_);
  }
  PairMotion motion(std::size_t n) const {
    if (!is_single_) return motions_[n];
    const PackedMotion& m = packed_motions_[n];
    return {static_cast<Real>(m.pressure), static_cast<Real>(m.vx), static_cast<Real>(m.vy),
            static_cast<Real>(m.vz)};
  }
  void set_motion(std::size_t n, const PairMotion& m) {
    if (is_single_) {
      packed_motions_[n] = {static_cast<float>(m.pressure), static_cast<float>(m.vx),
                            static_cast<float>(m.vy), static_cast<float>(m.vz)};
    } else {
      motions_[n] = m;
    }
  }

  /// Sets the charges, which are weights times an arbitrary factor: charge(s) for liquid slot s, 0
  /// for solids. Images have the charges of their sources.
  template <class Charge>
  void set_charges(TaskRunner* runner, Charge&& charge) {
    is_single_ ? charge_copies(runner, packed_places_, packed_charges_, charge)
               : charge_copies(runner, places_, charges_, charge);
  }

  /// Returns the number of sources for which motions can be stored.
  std::size_t motion_count() const { return std::max(packed_motions_.size(), motions_.size()); }

  /// inputs() returns the inputs of sums with positions, weights and motions. charged_inputs()
  /// returns inputs with charges in place of weights.
  PairInputs inputs() const;
  PairInputs charged_inputs() const;
  Real weight(std::size_t n) const {
    return is_single_ ? static_cast<Real>(packed_places_[n].weight) : places_[n].weight;
  }
  /// Returns the position of source n [m], rounded as in the sums.
  Vec3 place(std::size_t n) const {
    if (is_single_) return grid_.place(packed_places_[n]);
    return {places_[n].x, places_[n].y, places_[n].z};
  }

  /// Returns the precision of the sums: that of the scene, or double precision if the extent is too
  /// large.
  PairPrecision precision() const {
    return is_single_ ? PairPrecision::single_precision : PairPrecision::double_precision;
  }
  /// Returns the number of sources, without the padding.
  std::size_t count() const { return count_; }
  Index first_solid() const { return solids_; }
  Index first_image() const { return images_begin_; }
  /// Returns the source that is the particle of image n, or n if source n is a particle.
  Index source_of(Index n) const;
  /// Return the first image in a wall, and the first image of liquid in a wall.
  Index first_mirrored() const { return images_[mirrored_solids].first; }
  Index first_mirrored_liquid() const { return images_[mirrored_liquid].first; }
  /// Return all groups of sources, and the groups of liquid.
  std::array<SourceGroup, 6> groups(const UniformGrid& liquid, const UniformGrid& solids) const;
  std::array<SourceGroup, 3> liquid_groups(const UniformGrid& liquid) const;
  const SearchCoordinates& search_coordinates() const { return search_; }

 private:
  struct ImageGroup {
    std::vector<PackedImage> all;  ///< by slot of `grid`
    UniformGrid grid;
    Index first = 0;  ///< first source

    std::size_t count() const { return all.size(); }
  };
  /// Columns of positions, by source.
  struct PlaceColumns {
    Vec3 search_origin;
    float* search_x;
    float* search_y;
    float* search_z;
    PositionGrid grid;
    PackedPlace* packed;  ///< null: `places` is used
    PairPlace* places;

    void set(std::size_t n, const Vec3& p) const {
      search_x[n] = static_cast<float>(p.x() - search_origin.x());
      search_y[n] = static_cast<float>(p.y() - search_origin.y());
      search_z[n] = static_cast<float>(p.z() - search_origin.z());
      if (packed != nullptr) {
        packed[n] = {grid.coordinate(p.x(), 0), grid.coordinate(p.y(), 1),
                     grid.coordinate(p.z(), 2), 0};
      } else {
        places[n] = {p.x(), p.y(), p.z(), 0};
      }
    }
  };
  enum Images : std::uint8_t { shifted_solids, shifted_liquid, mirrored_solids, mirrored_liquid };
  static constexpr std::array kAllImages = {shifted_solids, shifted_liquid, mirrored_solids,
                                            mirrored_liquid};
  SourceGroup group_of(Images which) const { return {&images_[which].grid, images_[which].first}; }
  void find_images(const StepContext& c, Real reach, Images kind);
  void join_images(const StepContext& c, Images kind);
  void set_weight(std::size_t n, Real weight) {
    if (is_single_) {
      packed_places_[n].weight = static_cast<float>(weight);
    } else {
      places_[n].weight = weight;
    }
  }
  template <class Motion>
  void turn_motions(TaskRunner* runner, std::vector<Motion>& motions) const {
    for (const ImageGroup& group : images_) {
      for_blocks(runner, group.count(), [&](std::size_t begin, std::size_t end) {
        const PackedImage* const images = group.all.data();
        Motion* const turned = motions.data() + group.first;
        for (std::size_t s = begin; s < end; ++s) {
          const Motion& source = motions[images[s].source];
          const auto turn = [&](std::size_t axis, auto v) {
            return ImageOffsets::reflects(images[s].offsets[axis]) ? -v : v;
          };
          turned[s] = {0, turn(0, source.vx), turn(1, source.vy), turn(2, source.vz)};
        }
      });
    }
  }
  template <class Place, class Charge>
  void charge_copies(TaskRunner* runner, const std::vector<Place>& places,
                     std::vector<Place>& charges, Charge&& charge) {
    using Number = decltype(Place::weight);
    if (charges_version_ != version_) {
      resize_closely(charges, places.size());
      for_blocks(runner, count_ + 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) charges[n] = places[n];
      });
      charges_version_ = version_;
    }
    VAT_CHECK(charges.size() > count_);
    for_blocks(runner, images_begin_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        charges[n].weight = places[n].weight * (n < solids_ ? static_cast<Number>(charge(n)) : 0);
      }
    });
    for (const ImageGroup& group : images_) {
      for_blocks(runner, group.count(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
          charges[group.first + s].weight = charges[group.all[s].source].weight;
        }
      });
    }
  }
  /// Allocates space for `count` sources and the padding. The content of this space is undefined.
  void make_room(std::size_t count);
  PlaceColumns place_columns();
  void set_places(const StepContext& c);
  void sort_images(Images kind, TaskRunner* runner);
  void add_padding(Real reach);

  bool is_single_ = true;           ///< true: the packed arrays are used; false: the others
  std::vector<PairPlace> places_;   ///< by source, including the padding
  std::vector<PairPlace> charges_;  ///< places_ with charges in place of weights
  std::vector<PairMotion> motions_;
  PositionGrid grid_;
  std::vector<PackedPlace> packed_places_;
  std::vector<PackedPlace> packed_charges_;
  std::vector<PackedMotion> packed_motions_;

  std::size_t count_ = 0;
  Index solids_ = 0;  ///< first solid source
  Index images_begin_ = 0;
  std::array<ImageGroup, 4> images_;
  ImageOffsets offsets_;
  std::vector<std::vector<PackedImage>> found_;  ///< by block of particles
  std::vector<std::size_t> found_begin_;  ///< by block of particles: index of its first image
  // Images of the last group that was found, in the order of their sources:
  std::vector<PackedImage> image_list_;
  std::vector<Vec3> image_points_;
  SearchCoordinates search_;
  std::uint64_t version_ = 0;
  std::uint64_t charges_version_ = 0;  ///< version_ of the positions of the charges
  std::uint64_t liquid_version_ = 0;
  std::uint64_t solid_version_ = 0;
  Vec3 wall_offset_ = Vec3::Zero();
};

}  // namespace vat
