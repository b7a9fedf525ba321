#include "core/liquid/pairs/pair_sources.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/liquid/pairs/scratch.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/stage/context.h"
#include "core/support/check.h"

namespace vat {
namespace {

Vec3 place_of(const CellSortedPoints& points, std::size_t slot) {
  return {points.x[slot], points.y[slot], points.z[slot]};
}

/// The positions without images: farther than `reach` from all walls and from the sides of a
/// periodic box.
class ShowBox {
 public:
  ShowBox(const Model& model, const VatMotion& motion, Real reach) {
    low_.setConstant(-std::numeric_limits<Real>::infinity());
    high_ = -low_;
    const Real sure = reach * (1 + 1e-6);
    for (const int wall : model.walls) {
      const int axis = wall / 2;
      const Real offset = motion.offset[axis];
      const Vat& vat = *model.scene.vat;
      if (wall % 2 == 0) {
        low_[axis] = vat.min[axis] + offset + sure;
      } else {
        high_[axis] = vat.max[axis] + offset - sure;
      }
    }
    if (!model.scene.periodic) return;
    for (int axis = 0; axis < 3; ++axis) {
      if (!model.periodic.repeats(axis)) continue;
      low_[axis] = model.scene.periodic->min[axis] + sure;
      high_[axis] = model.scene.periodic->max[axis] - sure;
    }
  }
  bool hides(Real x, Real y, Real z) const {
    return x > low_.x() && y > low_.y() && z > low_.z() && x < high_.x() && y < high_.y() &&
           z < high_.z();
  }

 private:
  Vec3 low_;
  Vec3 high_;
};

/// Calls f(image) for the periodic images of source `n` at `p` that reach into the box.
template <class F>
void for_each_shifted(const Model& model, Index n, const Vec3& p, Real reach, F&& f) {
  model.periodic.for_each_image(p, reach, [&](const Vec3& shift) {
    if (!shift.isZero(0)) f(PairImage{shift, n, {}});
  });
}

/// Calls f(image) for the images of source `n` at `p` in walls of a periodic world.
template <class F>
void for_each_mirrored(const Model& model, const VatMotion& motion, Index n, const Vec3& p,
                       Real reach, F&& f) {
  for_each_mirror(model, motion, p, reach, [&](const Mirror& mirror) {
    model.periodic.for_each_image(mirror.place(p), reach, [&](const Vec3& shift) {
      f(PairImage{mirror.twice_plane + shift, n, mirror.axes});
    });
  });
}

/// The box of all sources. An image is as far outside a wall as its source is inside, within
/// `reach`.
std::array<Vec3, 2> box_around(const UniformGrid& liquid, const UniformGrid* solids, Real reach) {
  Vec3 low = liquid.origin();
  Vec3 high = liquid.end();
  if (solids != nullptr) {
    low = low.cwiseMin(solids->origin());
    high = high.cwiseMax(solids->end());
  }
  const Vec3 beside = Vec3::Constant(4 * reach);
  return {low - beside, high + beside};
}

}  // namespace

Mirror PairImage::mirror() const {
  Mirror mirror{axes, offset};
  for (int axis = 0; axis < 3; ++axis) {
    if (!axes[static_cast<std::size_t>(axis)]) mirror.twice_plane[axis] = 0;
  }
  return mirror;
}

ImageOffsets::ImageOffsets(const Model& model, const VatMotion& motion) {
  for (int axis = 0; axis < 3; ++axis) {
    std::array<Real, kKinds>& along = offsets_[static_cast<std::size_t>(axis)];
    if (model.periodic.repeats(axis)) {
      along[back] = -model.periodic.length(axis);
      along[on] = model.periodic.length(axis);
    }
    if (!model.scene.vat) continue;
    along[low_wall] = 2 * (model.scene.vat->min[axis] + motion.offset[axis]);
    along[high_wall] = 2 * (model.scene.vat->max[axis] + motion.offset[axis]);
  }
}

PackedImage ImageOffsets::pack(const PairImage& image) const {
  PackedImage packed{image.source, {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::array<Real, kKinds>& along = offsets_[axis];
    const Real offset = image.offset[static_cast<Eigen::Index>(axis)];
    std::uint8_t& kind = packed.offsets[axis];
    if (image.axes[axis]) {
      kind = offset == along[low_wall] ? low_wall : high_wall;
    } else if (offset != 0) {
      kind = offset < 0 ? back : on;
    }
    VAT_CHECK(offset == along[kind]);
  }
  return packed;
}

Index PairSources::source_of(Index n) const {
  VAT_CHECK(n < count_);
  if (n < images_begin_) return n;
  const auto group = std::ranges::find_if(
      images_, [&](const ImageGroup& one) { return n - one.first < one.count(); });
  VAT_CHECK(group != images_.end());
  return group->all[n - group->first].source;
}

void PairSources::find_images(const StepContext& c, Real reach, Images kind) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const bool is_solid = kind == shifted_solids || kind == mirrored_solids;
  const bool is_mirrored = kind == mirrored_solids || kind == mirrored_liquid;
  const CellSortedPoints& points = is_solid ? buffers.solids_in_liquid : buffers.liquid;
  const Index first = is_solid ? solids_ : 0;
  const std::size_t count = points.grid.order().size();
  const VatMotion motion = motion_of(c);
  const ShowBox shown(c.model, motion, reach);
  found_.resize(block_count(count));
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    // Moved out, so that threads do not share the cache line of its size.
    std::vector<PackedImage> found = std::move(found_[begin / kBlockSize]);
    found.clear();
    const auto add = [&](const PairImage& image) { add_closely(found, offsets_.pack(image)); };
    const bool is_plain = is_mirrored && !c.model.periodic.any();
    for (std::size_t s = begin; s < end; ++s) {
      if (shown.hides(points.x[s], points.y[s], points.z[s])) continue;
      const Index n = first + static_cast<Index>(s);
      const Vec3 p = place_of(points, s);
      if (is_plain) {
        for_each_wall_set(c.model, motion, p, reach, [&](std::span<const int> walls) {
          add_closely(found, ImageOffsets::in_walls(n, walls));
        });
        continue;
      }
      is_mirrored ? for_each_mirrored(c.model, motion, n, p, reach, add)
                  : for_each_shifted(c.model, n, p, reach, add);
    }
    found_[begin / kBlockSize] = std::move(found);
  });
}

/// Collects the found images in one column, and finds their cells.
void PairSources::join_images(const StepContext& c, Images kind) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const bool is_solid = kind == shifted_solids || kind == mirrored_solids;
  const CellSortedPoints& points = is_solid ? buffers.solids_in_liquid : buffers.liquid;
  const Index first = is_solid ? solids_ : 0;
  std::size_t total = 0;
  found_begin_.clear();
  for (const std::vector<PackedImage>& found : found_) {
    found_begin_.push_back(total);
    total += found.size();
  }
  resize_closely(image_list_, total);
  resize_closely(image_points_, total);
  for_blocks<1>(c.runner, found_.size(), [&](std::size_t b, std::size_t) {
    std::size_t k = found_begin_[b];
    for (const PackedImage& image : found_[b]) {
      image_list_[k] = image;
      const Vec3 source = place_of(points, image.source - first);
      image_points_[k++] = offsets_.unpack(image).place(source);
    }
  });
  images_[kind].grid.build(image_points_, pair_cell_size(c.model), c.runner);
}

void PairSources::set_places(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const auto set = [&](const CellSortedPoints& points, Index first) {
    for_blocks(c.runner, points.grid.order().size(), [&](std::size_t begin, std::size_t end) {
      const PlaceColumns columns = place_columns();
      for (std::size_t s = begin; s < end; ++s) columns.set(first + s, place_of(points, s));
    });
  };
  set(buffers.liquid, 0);
  if (images_begin_ > solids_) set(buffers.solids_in_liquid, solids_);
}

/// Stores the found images and their positions in the order of their cells.
void PairSources::sort_images(Images kind, TaskRunner* runner) {
  ImageGroup& group = images_[kind];
  const std::span<const Index> order = group.grid.order();
  resize_closely(group.all, order.size());
  for_blocks(runner, group.count(), [&](std::size_t begin, std::size_t end) {
    const PlaceColumns columns = place_columns();
    for (std::size_t s = begin; s < end; ++s) {
      group.all[s] = image_list_[order[s]];
      columns.set(group.first + s, image_points_[order[s]]);
    }
  });
}

void PairSources::set_weights(const StepContext& c, const WeightFactors& factors) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const Model& model = c.model;
  VAT_CHECK(c.model.rest_volume.size() == c.model.particle_count);
  const Real scale = model.liquids[model.material[0]]->kernel.scale();
  const std::span<const Index> order = buffers.liquid.grid.order();
  const std::span<const Index> solids = buffers.solids_in_liquid.grid.order();
  for_blocks(c.runner, images_begin_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const bool is_solid = n >= solids_;
      const Index i = is_solid ? model.liquid_count + solids[n - solids_] : order[n];
      const Real factor = is_solid ? factors.solid : factors.liquid[model.material[i]];
      set_weight(n, model.rest_volume[i] * scale * factor);
    }
  });
  for (const ImageGroup& group : images_) {
    for_blocks(c.runner, group.count(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        set_weight(group.first + s, weight(group.all[s].source));
      }
    });
  }
}

void PairSources::make_room(std::size_t count) {
  constexpr std::size_t kMaxLanes = 16;  // loads may extend beyond the last source
  const auto grow = [&](auto& column, std::size_t room) {
    resize_closely(column, std::max(column.size(), room));
  };
  for (std::vector<float>* column : {&search_.x, &search_.y, &search_.z}) {
    grow(*column, count + kMaxLanes);
  }
  if (is_single_) {
    grow(packed_places_, count + 1);
  } else {
    grow(places_, count + 1);
  }
}

PairSources::PlaceColumns PairSources::place_columns() {
  return {search_.origin,
          search_.x.data(),
          search_.y.data(),
          search_.z.data(),
          grid_,
          is_single_ ? packed_places_.data() : nullptr,
          places_.data()};
}

/// The padding is far from all positions, and finite in single precision.
void PairSources::add_padding(Real reach) {
  constexpr Real kFar = 1e6;
  if (is_single_) {
    packed_places_[count_] = {PositionGrid::kFar, PositionGrid::kFar, PositionGrid::kFar, 0};
  } else {
    const Vec3 far = search_.origin - Vec3::Constant(kFar * reach);
    places_[count_] = {far.x(), far.y(), far.z(), 0};
  }
}

void PairSources::make_room_for_motions() {
  if (is_single_) {
    resize_closely(packed_motions_, count_ + 1);
    packed_motions_[count_] = {};
  } else {
    resize_closely(motions_, count_ + 1);
    motions_[count_] = {};
  }
}

PairInputs PairSources::inputs() const {
  VAT_CHECK((is_single_ ? packed_places_.size() : places_.size()) > count_);
  PairInputs inputs;
  inputs.grid = grid_;
  inputs.first_mirrored = first_mirrored();
  if (is_single_) {
    inputs.packed_places = packed_places_.data();
    inputs.packed_motions = packed_motions_.data();
  } else {
    inputs.places = places_.data();
    inputs.motions = motions_.data();
  }
  return inputs;
}

PairInputs PairSources::charged_inputs() const {
  PairInputs inputs = this->inputs();
  if (is_single_) {
    inputs.packed_places = packed_charges_.data();
  } else {
    inputs.places = charges_.data();
  }
  return inputs;
}

std::array<SourceGroup, 6> PairSources::groups(const UniformGrid& liquid,
                                               const UniformGrid& solids) const {
  return {SourceGroup{&liquid, 0},  SourceGroup{&solids, solids_}, group_of(shifted_solids),
          group_of(shifted_liquid), group_of(mirrored_solids),     group_of(mirrored_liquid)};
}

std::array<SourceGroup, 3> PairSources::liquid_groups(const UniformGrid& liquid) const {
  return {SourceGroup{&liquid, 0}, group_of(shifted_liquid), group_of(mirrored_liquid)};
}

bool PairSources::is_current(const StepContext& c) const {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  return version_ > 0 && liquid_version_ == buffers.liquid.version &&
         solid_version_ == buffers.solids_in_liquid.version && wall_offset_ == motion_of(c).offset;
}

void PairSources::build(const StepContext& c, Real reach) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  VAT_CHECK(reach > 0);
  ++version_;
  liquid_version_ = buffers.liquid.version;
  solid_version_ = buffers.solids_in_liquid.version;
  wall_offset_ = motion_of(c).offset;
  const CellSortedPoints& liquid = buffers.liquid;
  const CellSortedPoints& solids = buffers.solids_in_liquid;
  const bool solid = has_solids(c.model);
  solids_ = static_cast<Index>(liquid.grid.order().size());
  images_begin_ = solids_ + (solid ? static_cast<Index>(solids.grid.order().size()) : 0);
  search_.origin = liquid.grid.origin();
  const auto [low, high] = box_around(liquid.grid, solid ? &solids.grid : nullptr, reach);
  const Real span = (high - low).maxCoeff();
  grid_ = PositionGrid(low, span);
  is_single_ = c.model.scene.pair_precision == PairPrecision::single_precision &&
               span <= kMaxSupports * reach;
  Index end = images_begin_;
  make_room(end);
  set_places(c);
  offsets_ = ImageOffsets(c.model, motion_of(c));
  for (const Images kind : kAllImages) {
    const bool of_solids = kind == shifted_solids || kind == mirrored_solids;
    const bool is_mirrored = kind == mirrored_solids || kind == mirrored_liquid;
    images_[kind].first = end;
    if ((of_solids && !solid) || (is_mirrored ? c.model.walls.empty() : !c.model.periodic.any())) {
      images_[kind].all.clear();
      continue;
    }
    find_images(c, reach, kind);
    join_images(c, kind);
    end += static_cast<Index>(image_list_.size());
    make_room(end);
    sort_images(kind, c.runner);
  }
  count_ = end;
  VAT_CHECK(images_begin_ <= count_ &&
            (is_single_ ? packed_places_.size() : places_.size()) > count_);
  add_padding(reach);
  set_weights(c, {});
}

}  // namespace vat
