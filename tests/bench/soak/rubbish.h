#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "protocol/json/json_reader.h"

namespace vat::bench {

/// Invalid messages: random bytes, malformed JSON, and requests of real methods with random values.
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

/// Sends bytes on a separate connection and closes it.
void send_raw(std::uint16_t port, const std::string& bytes);

}  // namespace vat::bench
