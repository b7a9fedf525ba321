#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Entropy coder of FRAMES.md. Three range asymmetric numeral systems (rANS; J. Duda,
/// arXiv:1311.2540) are interleaved. Frequencies have 12 bits, and words have 16 bits.
namespace vat::rans {

inline constexpr int kScaleBits = 12;
inline constexpr std::uint32_t kScale = 1U << kScaleBits;
inline constexpr std::uint32_t kMinState = 1U << 15;  // states are in [kMinState, 2^31)
inline constexpr std::size_t kLanes = 3;
inline constexpr std::size_t kStateBytes = 4 * kLanes;

/// An rANS encoder. Collects symbols in reading order and encodes the symbols in reverse order.
class Encoder {
 public:
  void clear() { symbols_.clear(); }
  /// Appends a symbol that occupies the slots [start, start + frequency) of 4096.
  void put(std::uint32_t lane, std::uint32_t start, std::uint32_t frequency) {
    symbols_.push_back(start | frequency << 12 | lane << 25);
  }
  /// Appends the states of all lanes and the encoded words.
  void finish(std::vector<std::uint8_t>& bytes);

 private:
  std::vector<std::uint32_t> symbols_;
  std::vector<std::uint16_t> words_;
};

/// An rANS decoder. After the end of the data, the decoder reads zeros and ended_early() is true.
class Decoder {
 public:
  /// Reads the initial states. If there are too few bytes, ended_early() is true.
  explicit Decoder(std::span<const std::uint8_t> bytes) : next_(bytes.data()), left_(bytes.size()) {
    for (std::uint32_t& state : states_) {
      const std::uint32_t low = word();
      state = low | word() << 16;
    }
  }
  /// Returns whether every state is in the encoder's range.
  bool states_are_valid() const {
    for (const std::uint32_t state : states_) {
      if (state < kMinState || state >> 31 != 0) return false;
    }
    return true;
  }

  std::uint32_t slot(std::uint32_t lane) const { return states_[lane] & (kScale - 1); }
  void take(std::uint32_t lane, std::uint32_t start, std::uint32_t frequency) {
    std::uint32_t state = states_[lane];
    state = frequency * (state >> kScaleBits) + (state & (kScale - 1)) - start;
    if (state < kMinState) state = state << 16 | word();
    states_[lane] = state;
  }

  bool ended_early() const { return ended_early_; }
  std::size_t bytes_left() const { return left_; }
  /// Returns whether the states equal the encoder's initial states. This is true after the last
  /// symbol of valid data.
  bool is_at_start() const {
    return states_ == std::array<std::uint32_t, kLanes>{kMinState, kMinState, kMinState};
  }

 private:
  std::uint32_t word() {
    if (left_ < 2) {
      ended_early_ = true;
      left_ = 0;
      return 0;
    }
    const std::uint32_t value = next_[0] | static_cast<std::uint32_t>(next_[1]) << 8;
    next_ += 2;
    left_ -= 2;
    return value;
  }

  const std::uint8_t* next_;
  std::size_t left_;
  std::array<std::uint32_t, kLanes> states_{};
  bool ended_early_ = false;
};

}  // namespace vat::rans
