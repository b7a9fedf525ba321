#include "protocol/frame/block_coder.h"

namespace vat {
namespace {

constexpr std::uint32_t kOrderBits = 5;

/// Codes a gap by an exponential Golomb code of the given order. A reader's result is unchecked.
template <class Coder>
std::uint64_t code_gap(Coder& coder, std::uint64_t gap, std::uint32_t order) {
  const std::uint64_t raised = gap + (std::uint64_t{1} << order);
  const auto length = static_cast<std::uint32_t>(std::bit_width(raised)) - 1;
  std::uint32_t bits = order;
  while (bits < 32 && coder.flag(bits < length, kEven)) ++bits;
  std::uint64_t result = 0;
  for (std::uint32_t done = 0; done < bits;) {
    const std::uint32_t count = std::min(bits - done, 12U);
    const auto part = static_cast<std::uint32_t>(raised >> done & ((1U << count) - 1));
    result |= std::uint64_t{coder.bits(part, count)} << done;
    done += count;
  }
  return result + (std::uint64_t{1} << bits) - (std::uint64_t{1} << order);
}

/// The distribution of the gaps between added numbers.
struct Spread {
  std::uint32_t chances = 1;  ///< probability, of 4096, that a number is its predecessor + 1
  std::uint32_t order = 0;    ///< order of the code of other gaps
};

Spread spread_of(const std::vector<std::uint32_t>& numbers) {
  std::uint64_t next = 0;
  std::uint64_t apart = 0;
  std::uint64_t sum = 0;
  for (const std::uint32_t number : numbers) {
    if (number != next) {
      ++apart;
      sum += number - next - 1;
    }
    next = std::uint64_t{number} + 1;
  }
  const std::uint64_t followers = numbers.size() - apart;
  Spread spread;
  spread.chances = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(followers * rans::kScale / numbers.size(), 1, rans::kScale - 1));
  if (apart > 0 && sum / apart > 0) {
    spread.order = static_cast<std::uint32_t>(std::bit_width(sum / apart)) - 1;
  }
  return spread;
}

}  // namespace

template <class Coder>
void code_numbers(Coder& coder, std::vector<std::uint32_t>& numbers, std::size_t count) {
  numbers.resize(count);
  if (count == 0) return;
  Spread spread;
  if constexpr (!Coder::kReads) spread = spread_of(numbers);
  spread.chances = coder.bits(spread.chances, kChanceBits);
  spread.order = coder.bits(spread.order, kOrderBits);
  if (spread.chances == 0) return coder.refuse();
  std::uint64_t next = 0;
  for (std::uint32_t& number : numbers) {
    if (!coder.flag(number == next, spread.chances)) {
      next += 1 + code_gap(coder, Coder::kReads ? 0 : number - next - 1, spread.order);
    }
    if (next > 0xffffffff) return coder.refuse();
    keep<Coder>(number, next);
    ++next;
  }
}

template void code_numbers(SymbolWriter&, std::vector<std::uint32_t>&, std::size_t);
template void code_numbers(SymbolReader&, std::vector<std::uint32_t>&, std::size_t);

}  // namespace vat
