#include "core/limits.h"
#include "protocol/scene/obj_mesh.h"
#include "tests/fuzz/target.h"

/// The input is an `.obj` text. An accepted mesh has vertices in range and valid vertex indices.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const Result<MeshShape> mesh = read_obj(std::string(fuzz::to_text(data, size)), "fuzz.obj", 0.5);
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
