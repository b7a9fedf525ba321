#include "protocol/convert/splishsplash.h"
#include "tests/fuzz/target.h"

namespace {

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

vat::Result<std::string> any_mesh(const std::string& name) {
  if (name.ends_with(".obj")) return std::string(kTetrahedron);
  return vat::Error{"no_such_file", "", "there are only meshes"};
}

}  // namespace

/// The input is a scene of SPlisHSPlasH. The text of a converted scene is a valid scene. Errors and
/// omissions have paths into the input, and texts.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const Result<Json> document = parse_json(fuzz::to_text(data, size), kSplishsplashLimits);
  if (!document) return 0;
  const Result<ConvertedScene> converted = convert_splishsplash(document.value(), any_mesh);
  if (!converted) {
    VAT_CHECK(!converted.errors().empty());
    for (const Error& error : converted.errors()) {
      VAT_CHECK(!error.message.empty() && (error.path.empty() || error.path.front() == '/'));
    }
    return 0;
  }
  for (const Omission& omission : converted.value().omissions) {
    VAT_CHECK(omission.path.starts_with('/') && !omission.reason.empty());
  }
  VAT_CHECK(read_scene_text(scene_text(converted.value().document), any_mesh).ok());
  return 0;
}
