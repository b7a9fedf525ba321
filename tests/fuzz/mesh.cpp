#include "core/limits.h"
#include "protocol/scene/mesh_file.h"
#include "tests/fuzz/target.h"

/// The first byte of the input is the format, the others are the file. An accepted mesh has
/// vertices in range and valid vertex indices.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  constexpr const char* kFiles[] = {"a.obj", "a.stl", "a.ply", "a.glb", "a.gltf"};
  if (size == 0) return 0;
  const std::string bytes(fuzz::to_text(data + 1, size - 1));
  const Result<MeshShape> mesh = read_mesh(bytes, kFiles[data[0] % std::size(kFiles)], 0.5);
  if (!mesh) return 0;
  VAT_CHECK(!mesh.value().triangles.empty() && mesh.value().triangles.size() <= kMaxMeshTriangles);
  for (const Vec3& vertex : mesh.value().vertices) {
    VAT_CHECK((vertex.array().abs() <= kMaxLength).all());
  }
  for (const auto& triangle : mesh.value().triangles) {
    for (const Index corner : triangle) VAT_CHECK(corner < mesh.value().vertices.size());
  }
  return 0;
}
