/** The layers of the camera. */
export const kLayers = {
  /** Objects that a liquid covers or refracts. */
  scene: 0,
  /** Marks over the scene. */
  marks: 1,
  splats: 2,
  fluidDepth: 3,
  fluidThickness: 4,
  /** Bodies that cast shadows; they are in the scene too. */
  casters: 5,
  /** Liquids that cast coloured shadows. */
  liquidShadow: 6,
};
