#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.h"
#include "server/output/alembic/ogawa_file.h"

namespace vat {

/// Type of the numbers of a property, with the number of the format.
enum class AbcType : std::uint8_t {
  boolean = 0,
  uint8 = 1,
  int32 = 6,
  uint64 = 7,
  float32 = 10,
  float64 = 11,
};

/// Property of an object: one sample of `extent` numbers, or of an array of them, at each output
/// time. A property with one sample is constant.
struct AbcProperty {
  std::string name;
  std::string meta;  ///< "key=value;key=value", with the keys in alphabetical order
  AbcType type = AbcType::float32;
  unsigned extent = 1;
  bool is_array = false;
  bool is_timed = false;  ///< has a sample at each output time
  std::vector<OgawaFile::Place> samples{};
  std::vector<std::size_t> sizes{};  ///< numbers of bytes of the samples
  std::uint64_t hash = 0;            ///< of the samples
};

/// Object of a schema, whose properties are in one compound.
struct AbcObject {
  std::string name;
  std::string schema;    ///< for example "AbcGeom_Xform_v3"
  std::string compound;  ///< ".xform" or ".geom"
  std::deque<AbcProperty> properties{};
  std::deque<AbcObject> children{};
};

/// Archive in the Ogawa form of Alembic. Samples are written at once; objects and properties when
/// the archive is completed.
class AbcArchive {
 public:
  explicit AbcArchive(OgawaFile file) : file_(std::move(file)) {}

  /// Objects below the root, whose addresses remain valid.
  std::deque<AbcObject> objects;
  std::vector<double> times;  ///< output times [s]

  /// Writes a sample: the numbers as little-endian bytes.
  void add_sample(AbcProperty& property, std::string_view bytes);
  /// Adds the last sample again.
  void repeat_sample(AbcProperty& property);
  const Status& status() const { return file_.status(); }
  Status complete();
  Status commit() { return file_.commit(); }

 private:
  OgawaFile::Place write_objects(const std::deque<AbcObject>& objects, OgawaFile::Place compound,
                                 std::uint64_t data_hash);
  OgawaFile::Place write_object(const AbcObject& object);
  OgawaFile::Place write_property(const AbcProperty& property);
  void append_property_header(std::string& bytes, const AbcProperty& property);
  void append_compound_header(std::string& bytes, const std::string& name, const std::string& meta);
  std::size_t meta_index(const std::string& meta);
  std::string time_samplings() const;

  OgawaFile file_;
  std::vector<std::string> metas_;  ///< texts that headers name by their index + 1
};

}  // namespace vat
