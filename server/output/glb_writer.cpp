#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "protocol/files/output_file.h"
#include "protocol/files/text.h"
#include "protocol/scene/appearance.h"
#include "server/output/frame_formats.h"
#include "server/output/glb_document.h"
#include "server/output/mesh/liquid_surface.h"

namespace vat {

namespace {

using nlohmann::json;

// Particles have one mesh per key frame. Viewers load all of them.
constexpr std::size_t kMaxKeyFrames = 120;
constexpr std::size_t kMaxKeyPoints = 20'000'000;  // of all key frames: 240 MB
constexpr std::size_t kMaxPoses = 20'000'000;      // of all rigid bodies and times: 560 MB

constexpr unsigned kPoints = 0;
constexpr unsigned kLines = 1;

/// Poses of a rigid body at all times, in the numbers of the format.
struct PoseSeries {
  std::vector<float> translations;
  std::vector<float> rotations;  ///< x, y, z, w

  void add(const RigidPose& pose) {
    for (const Real value : pose.center_of_mass) {
      translations.push_back(static_cast<float>(value));
    }
    Quat turn = pose.orientation.normalized();
    if (!rotations.empty()) {  // the sign for the shorter way from the last rotation
      const float* last = rotations.data() + rotations.size() - 4;
      Real product = 0;
      for (Eigen::Index i = 0; i < 4; ++i) product += turn.coeffs()[i] * static_cast<Real>(last[i]);
      if (product < 0) turn.coeffs() = -turn.coeffs();
    }
    for (const Real value : turn.coeffs()) rotations.push_back(static_cast<float>(value));
  }
};

/// Returns the first numbers of a series.
json first_of(const std::vector<float>& values, std::size_t count) {
  json list = json::array();
  for (std::size_t i = 0; i < count; ++i) list.push_back(values[i]);
  return list;
}

/// Animates rigid bodies as meshes, and shows the other particles as points, one mesh per key
/// frame. Only the mesh of the current key frame has a scale other than 0.
class GlbWriter final : public FrameWriter {
 public:
  GlbWriter(OutputFile file, std::string name, const FrameContent& content)
      : file_(std::move(file)),
        name_(std::move(name)),
        frame_count_(content.frame_count),
        has_surfaces_(content.has_liquid_surfaces) {}
  ~GlbWriter() override {
    // The run has already reported its error.
    if (!is_complete_ && !times_.empty()) static_cast<void>(write_document());
  }

  Status write(const Simulation& simulation) override {
    if (times_.empty()) start(simulation);
    const std::size_t frame = times_.size();
    times_.push_back(static_cast<float>(simulation.time()));
    const std::vector<BodyView> bodies = simulation.bodies();
    if (frame % pose_stride_ == 0 || frame + 1 == frame_count_) add_poses(simulation, bodies);
    if (frame % key_stride_ == 0) add_key_frame(simulation, bodies);
    return {};
  }

  Status finish() override {
    is_complete_ = true;
    if (Status written = write_document(); !written) return written;
    return file_.commit();
  }

 private:
  void start(const Simulation& simulation) {
    const auto stride = [&](std::size_t most) {
      return std::max<std::size_t>(1, (frame_count_ + most - 1) / std::max<std::size_t>(1, most));
    };
    const std::vector<BodyView> bodies = simulation.bodies();
    const std::size_t points = std::max<std::size_t>(1, simulation.particle_count());
    key_stride_ = stride(std::min(kMaxKeyFrames, kMaxKeyPoints / points));
    pose_stride_ = stride(kMaxPoses / std::max<std::size_t>(1, bodies.size()));
    for (const Material& material : simulation.scene().materials) {
      const FullAppearance look = full_appearance(material);
      materials_[material.name] = document_.add_material(material.name, look.colour, look.opacity,
                                                         look.roughness, look.metalness);
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) add_rigid_mesh(simulation, bodies[i], i);
    add_vat(simulation);
  }

  void add_rigid_mesh(const Simulation& simulation, const BodyView& body, std::size_t index) {
    if (body.kind != BodyKind::rigid) return;
    const Shape& shape = simulation.scene().bodies[index].shape;
    const std::size_t material = materials_.at(std::string(body.material));
    std::size_t mesh = 0;
    if (std::holds_alternative<ParticleShape>(shape)) {
      mesh = document_.add_mesh(json::array({points_of(body.local_positions, material)}));
    } else {
      SurfaceMesh surface = surface_of(shape);
      for (Vec3& vertex : surface.vertices) vertex += body.shape_origin;
      mesh = document_.add_mesh(surface, material);
    }
    rigid_nodes_[index] = {{"name", std::string(body.name)}, {"mesh", mesh}};
  }

  json points_of(std::span<const Vec3> positions, std::size_t material) {
    return {{"attributes", {{"POSITION", document_.add_positions(positions)}}},
            {"mode", kPoints},
            {"material", material}};
  }

  /// Adds the edges of the vat at time 0.
  void add_vat(const Simulation& simulation) {
    const auto& vat = simulation.scene().vat;
    if (!vat) return;
    std::vector<Vec3> ends;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
        if ((corner >> axis & 1) != 0) continue;
        for (const int end : {corner, corner | 1 << axis}) {
          ends.emplace_back((end & 1) != 0 ? vat->max.x() : vat->min.x(),
                            (end & 2) != 0 ? vat->max.y() : vat->min.y(),
                            (end & 4) != 0 ? vat->max.z() : vat->min.z());
        }
      }
    }
    json lines = {{"attributes", {{"POSITION", document_.add_positions(ends)}}}, {"mode", kLines}};
    const std::size_t mesh = document_.add_mesh(json::array({std::move(lines)}));
    vat_node_ = document_.add_node({{"name", "vat"}, {"mesh", mesh}});
  }

  void add_poses(const Simulation& simulation, const std::vector<BodyView>& bodies) {
    pose_times_.push_back(times_.back());
    for (const Real value : simulation.vat_offset()) {
      vat_offsets_.push_back(static_cast<float>(value));
    }
    for (const auto& [index, node] : rigid_nodes_) poses_[index].add(*bodies[index].pose);
  }

  /// Adds the particles of liquids and deformable bodies, with one primitive per material. Adds
  /// surfaces instead of the particles of liquids if the output has surfaces.
  void add_key_frame(const Simulation& simulation, const std::vector<BodyView>& bodies) {
    json primitives = json::array();
    for (const auto& [name, material] : materials_) {
      std::vector<Vec3> positions;
      for (const BodyView& body : bodies) {
        const bool is_surface = has_surfaces_ && body.kind == BodyKind::liquid;
        if (body.kind == BodyKind::rigid || body.material != name || is_surface) continue;
        positions.insert(positions.end(), body.positions.begin(), body.positions.end());
      }
      if (!positions.empty()) primitives.push_back(points_of(positions, material));
      if (!has_surfaces_) continue;
      const SurfaceMesh surface = liquid_surface(bodies, name);
      if (!surface.triangles.empty()) {
        primitives.push_back(document_.triangles_of(surface, material));
      }
    }
    std::string name = "particles at ";
    append_number(name, simulation.time());
    key_frames_.push_back({times_.back(), std::nullopt, name + " s"});
    if (!primitives.empty()) key_frames_.back().mesh = document_.add_mesh(std::move(primitives));
  }

  Status write_document() {
    add_moving_nodes();
    add_key_nodes();
    const std::string bytes = document_.bytes();
    if (bytes.empty()) return Error{"too_large", name_, "an output in .glb has at most 4 GiB"};
    return file_.append(bytes);
  }

  void add_moving_nodes() {
    const bool is_animated = pose_times_.size() > 1 && (vat_node_ || !rigid_nodes_.empty());
    const std::size_t times = is_animated ? document_.add_times(pose_times_) : 0;
    if (is_animated && vat_node_) {
      document_.animate(*vat_node_, "translation", "LINEAR", times,
                        document_.add_values("VEC3", vat_offsets_));
    }
    for (auto& [index, node] : rigid_nodes_) {
      const PoseSeries& series = poses_.at(index);
      node["translation"] = first_of(series.translations, 3);
      node["rotation"] = first_of(series.rotations, 4);
      const std::size_t number = document_.add_node(std::move(node));
      if (!is_animated) continue;
      document_.animate(number, "translation", "LINEAR", times,
                        document_.add_values("VEC3", series.translations));
      document_.animate(number, "rotation", "LINEAR", times,
                        document_.add_values("VEC4", series.rotations));
    }
  }

  void add_key_nodes() {
    const bool is_animated = key_frames_.size() > 1;
    std::map<std::vector<float>, std::size_t> scales;  // accessors that key frames share
    for (std::size_t k = 0; k < key_frames_.size(); ++k) {
      if (!key_frames_[k].mesh) continue;
      json node = {{"name", key_frames_[k].name}, {"mesh", *key_frames_[k].mesh}};
      if (k > 0) node["scale"] = {0U, 0U, 0U};
      const std::size_t number = document_.add_node(std::move(node));
      if (is_animated) animate_key_frame(k, number, scales);
    }
  }

  /// Shows a key frame from its time to that of the next one.
  void animate_key_frame(std::size_t k, std::size_t node,
                         std::map<std::vector<float>, std::size_t>& scales) {
    std::vector<float> times;
    std::vector<float> values;
    const auto add = [&](std::size_t key, float scale) {
      times.push_back(key_frames_[key].time);
      values.insert(values.end(), 3, scale);
    };
    if (k > 0) add(0, 0);
    add(k, 1);
    if (k + 1 < key_frames_.size()) add(k + 1, 0);
    auto found = scales.find(values);
    if (found == scales.end()) {
      found = scales.emplace(values, document_.add_values("VEC3", values)).first;
    }
    document_.animate(node, "scale", "STEP", document_.add_times(times), found->second);
  }

  struct KeyFrame {
    float time;
    std::optional<std::size_t> mesh;  ///< absent without particles
    std::string name;
  };

  OutputFile file_;
  std::string name_;
  std::size_t frame_count_;
  bool has_surfaces_;
  GlbDocument document_;
  std::map<std::string, std::size_t> materials_;  ///< by their names
  std::map<std::size_t, json> rigid_nodes_;       ///< by the indices of the bodies
  std::map<std::size_t, PoseSeries> poses_;
  std::optional<std::size_t> vat_node_;
  std::vector<float> vat_offsets_;
  std::vector<float> times_;  ///< of all outputs [s]
  std::vector<float> pose_times_;
  std::vector<KeyFrame> key_frames_;
  std::size_t key_stride_ = 1;
  std::size_t pose_stride_ = 1;
  bool is_complete_ = false;
};

}  // namespace

Result<std::unique_ptr<FrameWriter>> create_glb_writer(const std::string& name,
                                                       const FrameContent& content) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  return std::unique_ptr<FrameWriter>(
      std::make_unique<GlbWriter>(std::move(file).value(), name, content));
}

}  // namespace vat
