#include "server/output/array_header.h"

#include <cstdint>

#include "server/output/bytes.h"

namespace vat {

// Magic, version, length of the rest, and the array's type and shape as a Python literal, padded
// with spaces to a line of fixed length.
std::string array_header(const char* type, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kHeaderSize = 128;  // a multiple of 64, as the format asks; for any shape
  std::string header("\x93NUMPY\x01\x00", 8);
  append_bytes(header, static_cast<std::uint16_t>(kHeaderSize - header.size() - 2));
  header += "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) header += ", ";
    header += std::to_string(shape[i]);
  }
  header += shape.size() == 1 ? ",), }" : "), }";
  header.resize(kHeaderSize - 1, ' ');
  return header + '\n';
}

}  // namespace vat
