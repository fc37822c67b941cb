/** What both entries have beside the makers. */
export { BLOW } from './blow.js';
export { BurgeonError } from './errors.js';
export type {
  BloomOptions,
  Common,
  Fields,
  Flower,
  GrowOptions,
  LeafOptions,
  Makers,
  SketchOptions,
  SkinFields,
  Strokes,
  Tree,
} from './makers.js';
export type { ObjectOptions, Place, ThreeModule } from './object.js';
export { type Picture, Plant, type PlantMesh } from './plant.js';
export type { PartArrays, Tables } from './protocol.js';
export { FLOWERS, PARTS, TREES } from './spec.js';
export type { FlowerSpec, LeafSpec, SketchSpec, SkinSpec, TreeSpec } from './spec.js';
export type { Wind } from './wind.js';
export type {
  EngineReport,
  ItemReport,
  LevelView,
  MaterialView,
  PartView,
  PlantView,
  TextureView,
} from './wire.js';
