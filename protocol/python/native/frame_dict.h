#pragma once

#include <pybind11/pybind11.h>

#include "protocol/frame/grid_frame.h"

namespace vat::python {

/// Returns the members of vat.Frame, with the bodies as dictionaries of the members of FrameBody.
pybind11::dict frame_dict(const GridFrame& frame);

}  // namespace vat::python
