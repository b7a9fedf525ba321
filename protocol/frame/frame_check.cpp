#include "protocol/frame/frame_check.h"

#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

constexpr std::uint32_t kFactor = 16'777'619;

class Check {
 public:
  void add(std::uint32_t value) { sum_ = sum_ * kFactor + value; }
  std::uint32_t sum() const { return sum_; }

 private:
  std::uint32_t sum_ = 0;
};

template <class Values>
std::uint32_t check_of(const Values& values) {
  Check check;
  for (const auto value : values) check.add(static_cast<std::uint32_t>(value));
  return check.sum();
}

void add_particles(const GridBlock& block, std::size_t attributes, Check& check) {
  std::array<Check, 3> axes;
  for (std::size_t i = 0; i < block.positions.size(); i += 3) {
    for (std::size_t q = 0; q < 3; ++q) axes[q].add(block.positions[i + q]);
  }
  check.add(static_cast<std::uint32_t>(block.particle_count()));
  check.add(check_of(block.numbers));
  for (const Check& axis : axes) check.add(axis.sum());
  for (std::size_t a = 0; a < attributes; ++a) check.add(check_of(block.attributes[a]));
}

}  // namespace

std::uint32_t frame_check(const GridFrame& frame) {
  using namespace frame_layout;
  const std::size_t attributes =
      has_acceleration(frame.scale) ? kFrameAttributes : kScaleAttributes;
  Check check;
  for (const GridBlock& block : frame.blocks) {
    check.add(block.body);
    check.add(static_cast<std::uint32_t>(block.kind));
    if (block.has_particles()) {
      add_particles(block, attributes, check);
      continue;
    }
    check.add(block.orientation_bits);
    check.add(check_of(block.place));
    check.add(check_of(block.orientation));
  }
  return check.sum();
}

}  // namespace vat
