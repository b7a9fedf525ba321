#pragma once

#include <string>

#include "core/scene/scene.h"

/// A scene that uses every member of the format, as a document and as values, and a comparison of
/// scenes by their bits.
namespace vat::scene_cases {

/// A document with every member. No value equals its default.
extern const char* const kFullDocument;

/// The scene of kFullDocument, written without the reader.
Scene full_scene();

/// The mesh files of kFullDocument.
Result<std::string> full_meshes(const std::string& name);

/// A source without files.
Result<std::string> no_meshes(const std::string& name);

/// Returns all saved fields of the scene, and then the appearances of its materials. Equal bytes
/// mean equal scenes.
std::vector<std::uint8_t> bits_of(const Scene& scene);

/// Returns "code path" of every error, one per line; "" if there is none.
std::string lines(const Errors& errors);
template <class T>
std::string lines(const Result<T>& result) {
  return result.ok() ? "" : lines(result.errors());
}

}  // namespace vat::scene_cases
