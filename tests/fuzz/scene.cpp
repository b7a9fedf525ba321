#include "core/validation/validate.h"
#include "protocol/scene/scene_json.h"
#include "tests/fuzz/target.h"

namespace {

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

vat::Result<std::string> one_mesh(const std::string& name) {
  if (name == "a.obj") return std::string(kTetrahedron);
  return vat::Error{"no_such_file", "", "there is only a.obj"};
}

}  // namespace

/// The input is a scene text. An accepted scene is written and read again without a change. A
/// rejected one has errors with messages.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const Result<Scene> scene = read_scene_text(fuzz::to_text(data, size), one_mesh);
  if (!scene) {
    VAT_CHECK(scene.errors().size() <= kMaxReadErrors);
    for (const Error& error : scene.errors())
      VAT_CHECK(!error.code.empty() && !error.message.empty());
    return 0;
  }
  VAT_CHECK(find_errors(scene.value()).empty());
  const Json written = write_scene(scene.value());
  const Result<Scene> again = read_scene(written, one_mesh);
  VAT_CHECK(again.ok());
  VAT_CHECK(write_scene(again.value()) == written);
  return 0;
}
