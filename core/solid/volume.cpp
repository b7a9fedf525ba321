#include "core/solid/volume.h"

#include "core/laws/cell_volume.h"
#include "core/solid/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"
#include "core/support/check.h"

namespace vat {

void compute_cell_pressure(StepContext& c) {
  SolidScratch& solid_buffers = c.work.of<SolidScratch>();
  const SharedArray<VolumeCell>& cells = c.model.cells;
  solid_buffers.cell_pressure.resize(cells.size());
  for_blocks(c.runner, cells.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Real volume =
          cell_volume(c.configuration.position, cells[k].corners, c.model.scene.dimensions);
      solid_buffers.cell_pressure[k] = cells[k].bulk_modulus * (1 - volume / cells[k].volume);
    }
  });
}

// Each particle sums the forces of its cells, so that every force has one writer.
void add_cell_forces(StepContext& c) {
  const Index first = c.model.liquid_count;
  VAT_CHECK(c.work.of<SolidScratch>().cell_pressure.size() == c.model.cells.size());
  for_blocks(c.runner, c.model.free_count - first, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Index i = first + static_cast<Index>(k);
      Vec3 sum = Vec3::Zero();
      for (Index n = c.model.cell_begin[i]; n < c.model.cell_begin[i + 1]; ++n) {
        const CellCorner& corner = c.model.cell_corners[n];
        sum += c.work.of<SolidScratch>().cell_pressure[corner.cell] *
               cell_slope(c.configuration.position, c.model.cells[corner.cell].corners,
                          corner.corner, c.model.scene.dimensions);
      }
      c.forces.particle[i] += sum;
    }
  });
}

Real cell_energy(const Model& model, const Configuration& at) {
  Real energy = 0;
  for (const VolumeCell& cell : model.cells) {
    const Real change =
        cell_volume(at.position, cell.corners, model.scene.dimensions) - cell.volume;
    energy += 0.5 * cell.bulk_modulus * change * change / cell.volume;
  }
  return energy;
}

}  // namespace vat
