#include "server/output/alembic/abc_archive.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/support/hash.h"
#include "server/output/bytes.h"

namespace vat {

namespace {

using Place = OgawaFile::Place;

constexpr std::size_t kTextInHeader = 255;  // the index of a text that is not in the list
constexpr std::uint32_t kScalar = 1;
constexpr std::uint32_t kArray = 2;

std::uint64_t hash_of(std::string_view bytes) {
  StateHash hash;
  hash.add(std::uint64_t{bytes.size()});
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), sizeof(std::uint64_t)))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
    hash.add(word);
  }
  return hash.value();
}

std::uint64_t hash_of(std::uint64_t first, std::uint64_t second) {
  StateHash hash;
  hash.add(first);
  hash.add(second);
  return hash.value();
}

/// Returns the code of the number of bytes that numbers up to `greatest` need: 1, 2 or 4.
std::uint32_t size_hint(std::size_t greatest) {
  if (greatest < 256) return 0;
  return greatest < 65536 ? 1 : 2;
}

void append_hinted(std::string& bytes, std::size_t value, std::uint32_t hint) {
  if (hint == 0) return append_bytes(bytes, static_cast<std::uint8_t>(value));
  if (hint == 1) return append_bytes(bytes, static_cast<std::uint16_t>(value));
  append_bytes(bytes, static_cast<std::uint32_t>(value));
}

std::string schema_meta(const AbcObject& object) {
  std::string meta = "schema=" + object.schema;
  if (object.compound == ".geom") meta += ";schemaBaseType=AbcGeom_GeomBase_v1";
  return meta;
}

std::string object_meta(const AbcObject& object) {
  return schema_meta(object) + ";schemaObjTitle=" + object.schema + ':' + object.compound;
}

}  // namespace

void AbcArchive::add_sample(AbcProperty& property, std::string_view bytes) {
  // Readers identify samples by these 16 bytes in front of them.
  const std::uint64_t hash = hash_of(bytes);
  std::string content;
  content.reserve(16 + bytes.size());
  append_bytes(content, hash);
  append_bytes(content, hash_of(hash, bytes.size()));
  content += bytes;
  property.samples.push_back(bytes.empty() ? OgawaFile::kEmptyData : file_.add_data(content));
  property.sizes.push_back(bytes.size());
  property.hash = hash_of(property.hash, hash);
}

void AbcArchive::repeat_sample(AbcProperty& property) {
  property.samples.push_back(property.samples.back());
  property.sizes.push_back(property.sizes.back());
}

std::size_t AbcArchive::meta_index(const std::string& meta) {
  if (meta.empty()) return 0;
  const auto found = std::ranges::find(metas_, meta);
  if (found != metas_.end()) return static_cast<std::size_t>(found - metas_.begin()) + 1;
  if (meta.size() > 255 || metas_.size() + 2 >= kTextInHeader) return kTextInHeader;
  metas_.push_back(meta);
  return metas_.size();
}

Place AbcArchive::write_property(const AbcProperty& property) {
  std::vector<Place> children;
  for (const Place sample : property.samples) {
    children.push_back(sample);
    // The size of the sample determines the dimensions of an array.
    if (property.is_array) children.push_back(OgawaFile::kEmptyData);
  }
  return file_.add_group(children);
}

void AbcArchive::append_property_header(std::string& bytes, const AbcProperty& property) {
  const bool is_constant = property.samples.size() < 2;
  const std::size_t count = property.is_timed ? times.size() : property.samples.size();
  const std::size_t sampling = property.is_timed ? 1 : 0;
  const std::size_t meta = meta_index(property.meta);
  const std::uint32_t hint =
      size_hint(std::max({property.name.size(), property.meta.size(), count}));
  const bool is_even =
      std::ranges::adjacent_find(property.sizes, std::not_equal_to<>()) == property.sizes.end();
  std::uint32_t info = property.is_array ? kArray : kScalar;
  info |= hint << 2;
  info |= static_cast<std::uint32_t>(property.type) << 4;
  if (sampling != 0) info |= 0x100;
  if (is_even) info |= 0x400;
  if (is_constant) info |= 0x800;
  info |= property.extent << 12;
  info |= static_cast<std::uint32_t>(meta) << 20;
  append_bytes(bytes, info);
  append_hinted(bytes, count, hint);
  if (sampling != 0) append_hinted(bytes, sampling, hint);
  append_hinted(bytes, property.name.size(), hint);
  bytes += property.name;
  if (meta != kTextInHeader) return;
  append_hinted(bytes, property.meta.size(), hint);
  bytes += property.meta;
}

void AbcArchive::append_compound_header(std::string& bytes, const std::string& name,
                                        const std::string& meta) {
  const std::size_t index = meta_index(meta);
  const std::uint32_t hint = size_hint(std::max(name.size(), meta.size()));
  append_bytes(bytes, static_cast<std::uint32_t>(index << 20) | hint << 2);
  append_hinted(bytes, name.size(), hint);
  bytes += name;
  if (index != kTextInHeader) return;
  append_hinted(bytes, meta.size(), hint);
  bytes += meta;
}

Place AbcArchive::write_object(const AbcObject& object) {
  std::vector<Place> properties;
  std::string headers;
  std::uint64_t hash = hash_of(object.name);
  for (const AbcProperty& property : object.properties) {
    properties.push_back(write_property(property));
    append_property_header(headers, property);
    hash = hash_of(hash, property.hash);
  }
  properties.push_back(file_.add_data(headers));
  std::string header;
  append_compound_header(header, object.compound, schema_meta(object));
  const Place compound = file_.add_group(properties);
  const Place top = file_.add_group(std::vector{compound, file_.add_data(header)});
  return write_objects(object.children, top, hash);
}

Place AbcArchive::write_objects(const std::deque<AbcObject>& list, Place compound,
                                std::uint64_t data_hash) {
  std::vector<Place> children{compound};
  std::string headers;
  std::uint64_t hash = 0;
  for (const AbcObject& object : list) {
    children.push_back(write_object(object));
    const std::string meta = object_meta(object);
    const std::size_t index = meta_index(meta);
    append_bytes(headers, static_cast<std::uint32_t>(object.name.size()));
    headers += object.name;
    append_bytes(headers, static_cast<std::uint8_t>(index));
    if (index == kTextInHeader) {
      append_bytes(headers, static_cast<std::uint32_t>(meta.size()));
      headers += meta;
    }
    hash = hash_of(hash, children.back());
  }
  // Hashes of the properties and of the children, with which readers compare objects.
  for (const std::uint64_t part : {data_hash, hash_of(data_hash, 1), hash, hash_of(hash, 1)}) {
    append_bytes(headers, part);
  }
  children.push_back(file_.add_data(headers));
  return file_.add_group(children);
}

/// Returns the default sampling, one time unit from 0, and the output times.
std::string AbcArchive::time_samplings() const {
  constexpr double kEachTimeIsGiven = std::numeric_limits<double>::max() / 32;
  std::string bytes;
  append_bytes(bytes, std::uint32_t{1});
  append_bytes(bytes, 1.0);
  append_bytes(bytes, std::uint32_t{1});
  append_bytes(bytes, 0.0);
  append_bytes(bytes, static_cast<std::uint32_t>(times.size()));
  append_bytes(bytes, kEachTimeIsGiven);
  append_bytes(bytes, static_cast<std::uint32_t>(times.size()));
  for (const double time : times) append_bytes(bytes, time);
  return bytes;
}

Status AbcArchive::complete() {
  constexpr std::int32_t kFormatVersion = 0;
  constexpr std::int32_t kLibraryVersion = 10800;  // 1.8.0, whose format this is
  std::string format;
  std::string library;
  append_bytes(format, kFormatVersion);
  append_bytes(library, kLibraryVersion);
  const Place root = write_objects(objects, 0, 0);
  std::string metas;
  for (const std::string& meta : metas_) {
    append_bytes(metas, static_cast<std::uint8_t>(meta.size()));
    metas += meta;
  }
  const std::vector<Place> archive = {file_.add_data(format),
                                      file_.add_data(library),
                                      root,
                                      file_.add_data("_ai_Application=vat"),
                                      file_.add_data(time_samplings()),
                                      file_.add_data(metas)};
  return file_.complete(file_.add_group(archive));
}

}  // namespace vat
