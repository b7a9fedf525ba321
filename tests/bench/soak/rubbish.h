#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "protocol/json/json_reader.h"

namespace vat::bench {

/// Messages without sense: bytes of chance, broken JSON, and requests of real methods with values
/// of chance.
class Rubbish {
 public:
  explicit Rubbish(std::uint32_t seed) : chance_(seed) {}
  std::string text();
  std::string bytes();

 private:
  std::size_t below(std::size_t end);
  std::string request();
  Json value(int depth);

  std::mt19937 chance_;
};

/// Sends bytes on a connection of their own, which it then ends.
void send_raw(std::uint16_t port, const std::string& bytes);

}  // namespace vat::bench
