#include "server/http/static_files.h"

#include <openssl/sha.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace vat {

namespace {

namespace fs = std::filesystem;

Error unreadable(const fs::path& path, const std::string& reason) {
  return {"unreadable", "", "cannot read " + path.string() + ": " + reason};
}

Result<std::vector<fs::path>> list_files(const fs::path& folder, const StaticFilesLimits& limits) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (const fs::recursive_directory_iterator end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().starts_with('.')) {
      entry.disable_recursion_pending();
    } else if (entry->symlink_status(error).type() == fs::file_type::regular) {
      if (files.size() == limits.max_files) {
        return unreadable(folder, "more than " + std::to_string(limits.max_files) + " files");
      }
      files.push_back(entry->path());
    }
  }
  if (error) return unreadable(folder, error.message());
  return files;
}

/// Fails if the file has more than `max_size` bytes.
Result<std::string> read_file(const fs::path& path, std::size_t max_size) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return unreadable(path, error.message());
  if (size > max_size) return unreadable(path, "the files of the folder are too large together");
  std::ifstream file(path, std::ios::binary);
  std::string content(static_cast<std::size_t>(size), '\0');
  file.read(content.data(), static_cast<std::streamsize>(size));
  if (!file) return unreadable(path, "input error");
  return content;
}

std::string tag_of(const std::string& bytes) {
  constexpr std::size_t kTagBytes = 16;  // enough to tell files apart
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> hash{};
  SHA256(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), hash.data());
  std::string tag = "\"";
  for (std::size_t i = 0; i < kTagBytes; ++i) {
    tag += kDigits[hash[i] >> 4];
    tag += kDigits[hash[i] & 15];
  }
  return tag + '"';
}

}  // namespace

std::string content_type_of(const fs::path& name) {
  static const std::map<std::string, std::string> kTypes{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".txt", "text/plain; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/x-icon"},
      {".webp", "image/webp"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"}};
  const auto type = kTypes.find(name.extension().string());
  return type == kTypes.end() ? "application/octet-stream" : type->second;
}

Result<StaticFiles> StaticFiles::read(const fs::path& folder, const StaticFilesLimits& limits) {
  StaticFiles files;
  std::error_code ignored;  // a folder that cannot be looked at fails below
  if (fs::status(folder, ignored).type() == fs::file_type::not_found) return files;
  Result<std::vector<fs::path>> paths = list_files(folder, limits);
  if (!paths) return paths.errors();
  std::size_t left = limits.max_bytes;
  for (const fs::path& path : paths.value()) {
    Result<std::string> content = read_file(path, left);
    if (!content) return content.errors();
    left -= content.value().size();
    std::string tag = tag_of(content.value());
    files.files_.emplace(
        "/" + path.lexically_relative(folder).generic_string(),
        File{content_type_of(path),
             {{Encoding::identity, Content{std::move(content).value(), std::move(tag)}}}});
  }
  files.join_encodings();
  return files;
}

void StaticFiles::join_encodings() {
  for (const auto& [encoding, extension] :
       {std::pair(Encoding::brotli, ".br"), std::pair(Encoding::gzip, ".gz")}) {
    for (auto& [path, file] : files_) {
      auto encoded = files_.extract(path + extension);
      if (encoded.empty()) continue;
      file.contents[encoding] = std::move(encoded.mapped().contents.at(Encoding::identity));
    }
  }
}

const StaticFiles::File* StaticFiles::find(std::string_view path) const {
  const auto file = files_.find(path);
  return file == files_.end() ? nullptr : &file->second;
}

}  // namespace vat
