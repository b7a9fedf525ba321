#include "tests/bench/fanout/frame_facts.h"

#include <span>
#include <stdexcept>

#include "core/support/byte_io.h"
#include "protocol/frame/frame_layout.h"

namespace vat::bench {

FrameFacts frame_facts(std::string_view start) {
  ByteReader in({reinterpret_cast<const std::uint8_t*>(start.data()), start.size()});
  const bool is_ours = in.get<std::uint32_t>() == frame_layout::kMagic &&
                       in.get<std::uint8_t>() == frame_layout::kVersion;
  in.get<std::uint8_t>();   // type
  in.get<std::uint8_t>();   // flags
  in.get<std::uint8_t>();   // stride
  in.get<std::uint32_t>();  // epoch
  FrameFacts facts;
  facts.number = in.get<std::uint32_t>();
  facts.is_key = in.get<std::uint32_t>() == 0;  // both distances to references
  in.get<std::uint32_t>();
  in.get<std::uint64_t>();  // tick
  in.get<double>();         // time
  facts.published = in.get<double>();
  if (!is_ours || in.ended_early()) throw std::runtime_error("an invalid frame header");
  return facts;
}

std::string acknowledgement(const FrameFacts& facts) {
  return R"({"jsonrpc":"2.0","method":"frames.ack","params":{"number":)" +
         std::to_string(facts.number) + "}}";
}

}  // namespace vat::bench
