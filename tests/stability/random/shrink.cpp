#include "tests/stability/random/shrink.h"

#include <fstream>
#include <utility>
#include <vector>

#include "core/validation/validate.h"
#include "protocol/scene/scene_json.h"

namespace vat::stability {
namespace {

/// Halves the shape. Returns false if it cannot become smaller.
bool halve(Shape& shape, Real spacing) {
  if (auto* box = std::get_if<BoxShape>(&shape)) {
    if (box->size.maxCoeff() <= spacing) return false;
    box->size = (box->size / 2).cwiseMax(spacing);
    return true;
  }
  if (auto* sphere = std::get_if<SphereShape>(&shape)) {
    sphere->radius /= 2;
    return sphere->radius >= spacing / 2;
  }
  if (auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    cylinder->radius /= 2;
    cylinder->height /= 2;
    return cylinder->height >= spacing / 2;
  }
  if (auto* mesh = std::get_if<MeshShape>(&shape)) {
    for (Vec3& vertex : mesh->vertices) vertex /= 2;
    return (mesh->vertices[1] - mesh->vertices[0]).norm() >= spacing;
  }
  return false;
}

/// Returns smaller scenes, those with the largest reduction first.
std::vector<Scene> smaller(const Scene& scene) {
  std::vector<Scene> result;
  const auto offer = [&](auto&& change) {
    Scene candidate = scene;
    if (change(candidate)) result.push_back(std::move(candidate));
  };
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    offer([b](Scene& s) {
      s.bodies.erase(s.bodies.begin() + static_cast<std::ptrdiff_t>(b));
      return !s.bodies.empty();
    });
  }
  offer([](Scene& s) { return s.vat && std::exchange(s.vat->motion, std::nullopt).has_value(); });
  offer([](Scene& s) { return std::exchange(s.gravity, Vec3(Vec3::Zero())) != Vec3::Zero(); });
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    offer([i](Scene& s) {
      s.interfaces.erase(s.interfaces.begin() + static_cast<std::ptrdiff_t>(i));
      return true;
    });
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    offer([b](Scene& s) { return halve(s.bodies[b].shape, s.bodies[b].spacing); });
    offer([b](Scene& s) {
      return std::exchange(s.bodies[b].velocity, Vec3(Vec3::Zero())) != Vec3::Zero();
    });
    offer([b](Scene& s) {
      return std::exchange(s.bodies[b].angular_velocity, Vec3(Vec3::Zero())) != Vec3::Zero();
    });
  }
  return result;
}

}  // namespace

Scene shrink(const Scene& scene, const std::function<bool(const Scene&)>& fails, int tries) {
  Scene least = scene;
  for (bool shrunk = true; shrunk;) {
    shrunk = false;
    for (Scene& candidate : smaller(least)) {
      if (!find_errors(candidate).empty()) continue;
      if (--tries < 0) return least;
      if (!fails(candidate)) continue;
      least = std::move(candidate);
      shrunk = true;
      break;
    }
  }
  return least;
}

Status write_scene_file(const Scene& scene, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << write_scene(scene).dump(2) << '\n';
  if (!out.flush()) return Error{"cannot_write", "", file.string() + " cannot be written"};
  return {};
}

}  // namespace vat::stability
