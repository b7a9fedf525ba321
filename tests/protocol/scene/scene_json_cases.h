#pragma once

#include <string>

#include "core/scene/scene.h"
#include "protocol/scene/scene_json.h"

/// A scene that uses every member of the format, as a document and as values, and a comparison of
/// scenes by their bits.
namespace vat::scene_cases {

/// Every member is given, none with its default.
extern const char* const kFullDocument;

/// What kFullDocument stands for, written down without the reader.
Scene full_scene();

/// The mesh files that kFullDocument names.
Result<std::string> full_meshes(const std::string& name);

/// A source without files.
Result<std::string> no_meshes(const std::string& name);

/// All fields of the scene as they are saved: equal bytes, equal scenes.
std::vector<std::uint8_t> bits_of(const Scene& scene);

/// "code path" of every error, one a line; "" where there is none.
std::string lines(const Errors& errors);
template <class T>
std::string lines(const Result<T>& result) {
  return result.ok() ? "" : lines(result.errors());
}

}  // namespace vat::scene_cases
