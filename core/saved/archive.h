#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/saved/members.h"
#include "core/support/byte_io.h"
#include "core/support/names.h"
#include "core/support/result.h"
#include "core/types.h"

/// Conversion of values to little-endian bytes and back. The bytes of a struct are the bytes of its
/// members in the order of declaration. To save only some members, or to change their order, define
/// the following function. The function passes the saved members to the archive:
///
///     template <class Archive>
///     void describe(Archive& archive, Of<Archive, Struct>& value);
///
/// Numbers have the size of their type. Bools and enumerations have one byte. Strings and lists are
/// prefixed by their length in four bytes, an optional by a bool, and a variant by its index in one
/// byte.
namespace vat {

/// Type of the value argument of describe(). The value is const when it is saved.
template <class Archive, class T>
using Of = std::conditional_t<Archive::kLoads, T, const T>;

/// Passes the members of a struct to an archive.
template <class Archive, class T>
void describe_struct(Archive& archive, T& value) {
  if constexpr (requires { describe(archive, value); }) {
    describe(archive, value);
  } else {
    visit_members(value, archive);
  }
}

/// Last value of an enumeration. Values begin with 0 and have no gaps.
template <class Enumeration>
inline constexpr auto kLastOf = static_cast<Enumeration>(kNamesOf<Enumeration>.size() - 1);

/// Archive that appends values to a byte vector.
class SavingArchive {
 public:
  static constexpr bool kLoads = false;

  explicit SavingArchive(std::vector<std::uint8_t>& bytes) : writer_(bytes) {}

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      writer_.put(static_cast<std::uint8_t>(value));
    } else if constexpr (std::is_same_v<T, std::size_t>) {
      writer_.put(std::uint64_t{value});
    } else if constexpr (std::is_arithmetic_v<T>) {
      writer_.put(value);
    } else {
      describe_struct(*this, value);
    }
  }
  void put(const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) writer_.put(value[axis]);
  }
  void put(const Mat3& value) {
    for (int row = 0; row < 3; ++row) put(Vec3(value.row(row).transpose()));
  }
  void put(const Quat& value) {
    writer_.put(value.w());
    put(Vec3(value.vec()));
  }
  void put(const std::string& text) {
    writer_.put(static_cast<std::uint32_t>(text.size()));
    for (const char byte : text) writer_.put(byte);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    writer_.put(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) put(value);
  }
  template <class T, std::size_t count>
  void put(const std::array<T, count>& values) {
    for (const T& value : values) put(value);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    writer_.put(static_cast<std::uint8_t>(value.index()));
    std::visit([&](const auto& alternative) { put(alternative); }, value);
  }

  ByteWriter writer_;
};

/// Archive that reads values from bytes. After invalid bytes, all reads return zeros and empty
/// lists, and failed() remains true. A caller can therefore read all values and check once. The
/// memory for a list is limited by the number of remaining bytes.
class LoadingArchive {
 public:
  static constexpr bool kLoads = true;

  explicit LoadingArchive(std::span<const std::uint8_t> bytes) : reader_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  bool failed() const { return failed_ || reader_.ended_early(); }
  std::size_t left() const { return reader_.left(); }

 private:
  void fail() {
    failed_ = true;
    reader_ = ByteReader({});
  }
  /// Reads the length of a list whose elements have at least `least` bytes each. Fails if too few
  /// bytes remain.
  std::size_t get_length(std::size_t least) {
    const auto length = reader_.get<std::uint32_t>();
    if (length <= reader_.left() / least) return length;
    fail();
    return 0;
  }

  template <class T>
  void get(T& value) {
    if constexpr (std::is_enum_v<T>) {
      const auto number = reader_.get<std::uint8_t>();
      if (number > static_cast<std::uint8_t>(kLastOf<T>)) return fail();
      value = static_cast<T>(number);
    } else if constexpr (std::is_same_v<T, std::size_t>) {
      value = reader_.get<std::uint64_t>();
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = reader_.get<T>();
    } else {
      describe_struct(*this, value);
    }
  }
  void get(bool& value) {
    const auto number = reader_.get<std::uint8_t>();
    if (number > 1) return fail();
    value = number == 1;
  }
  void get(Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) value[axis] = reader_.get<Real>();
  }
  void get(Mat3& value) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) value(row, column) = reader_.get<Real>();
    }
  }
  void get(Quat& value) {
    value.w() = reader_.get<Real>();
    for (int axis = 0; axis < 3; ++axis) value.vec()[axis] = reader_.get<Real>();
  }
  void get(std::string& text) {
    text.resize(get_length(1));
    for (char& byte : text) byte = reader_.get<char>();
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.clear();
    if constexpr (std::is_arithmetic_v<T>) {
      values.resize(get_length(sizeof(T)));
      for (T& value : values) get(value);
    } else if constexpr (std::is_same_v<T, Vec3>) {
      values.resize(get_length(3 * sizeof(Real)));
      for (Vec3& value : values) get(value);
    } else {
      const std::size_t length = get_length(1);
      while (values.size() < length && !failed()) get(values.emplace_back());
    }
  }
  template <class T, std::size_t count>
  void get(std::array<T, count>& values) {
    for (T& value : values) get(value);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool is_there = false;
    get(is_there);
    value.reset();
    if (is_there) get(value.emplace());
  }
  template <class... T>
  void get(std::variant<T...>& value) {
    const auto which = reader_.get<std::uint8_t>();
    if (!get_alternative(which, value, std::index_sequence_for<T...>())) fail();
  }
  template <class... T, std::size_t... places>
  bool get_alternative(std::size_t which, std::variant<T...>& value,
                       std::index_sequence<places...>) {
    return ((which == places && (get(value.template emplace<places>()), true)) || ...);
  }

  ByteReader reader_;
  bool failed_ = false;
};

}  // namespace vat
