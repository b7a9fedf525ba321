#pragma once

#include <vector>

namespace vat::bench {

/// What a quantity grew by from the first of its values, at even distances, to the last: by the
/// straight line through them. Throws std::invalid_argument where they are fewer than two.
double find_growth(const std::vector<double>& values);

/// Whether what a server holds at its rests is the same at all but the first, which is its warming
/// up: it grows by no more than this share. Throws std::invalid_argument where there are fewer
/// than three.
bool is_flat(const std::vector<double>& resting, double most_growth);

}  // namespace vat::bench
