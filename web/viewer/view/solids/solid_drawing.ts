/** The part of the view that draws solids by their shapes. It is loaded beside the first picture. */
export { floorShadow } from '../shadow/floor_shadow';
export { SunShadow } from '../shadow/sun_shadow';
export { JoinedSolids } from './joined_solids';
export { solidOf } from './solid_of';
