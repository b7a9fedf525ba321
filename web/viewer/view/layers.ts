/** What the camera draws in one go; all but the first two are of liquids. */
export const kLayers = {
  /** Everything that a liquid covers or shows through. */
  scene: 0,
  /** Marks that lie over all else. */
  marks: 1,
  splats: 2,
  fluidDepth: 3,
  fluidThickness: 4,
};
