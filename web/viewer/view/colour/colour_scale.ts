import type { ViewSettings } from '../settings';
import type { LookUniforms } from '../shared_uniforms';
import { fillMapTexture, isDiverging } from './maps';
import { quantityOf } from './quantity';
import type { QuantityName } from './quantity';
import { AutoRange } from './range';
import type { Range } from './range';

/** What colours mean at the moment. */
export interface Meaning {
  quantity: QuantityName;
  map: ViewSettings['map'];
  range: Range;
}

/** Which number has which colour: the map, and the values at its ends, fixed or as they come. */
export class ColourScale {
  private settings: Pick<ViewSettings, 'colour' | 'map' | 'from' | 'to'> | undefined;
  private auto = new AutoRange(false);
  private frame: Range = { min: Infinity, max: -Infinity };
  private readonly listeners: ((meaning: Meaning | undefined) => void)[] = [];

  constructor(private readonly uniforms: LookUniforms) {}

  /** Tells, after each change, what colours mean; undefined: no numbers. */
  subscribe(listener: (meaning: Meaning | undefined) => void): void {
    this.listeners.push(listener);
  }

  apply(settings: Pick<ViewSettings, 'colour' | 'map' | 'from' | 'to'>): void {
    const old = this.settings;
    this.settings = settings;
    if (settings.map !== old?.map) fillMapTexture(this.uniforms.value_map.value, settings.map);
    if (settings.map !== old?.map || settings.colour !== old.colour) this.forget();
    this.show();
  }

  /** Values of one body of a frame. */
  add({ min, max }: Range): void {
    this.frame.min = Math.min(this.frame.min, min);
    this.frame.max = Math.max(this.frame.max, max);
  }

  /** All bodies of a frame have been added. */
  settle(): void {
    if (!this.settings || !quantityOf(this.settings.colour)) return;
    this.auto.add(this.frame);
    this.frame = { min: Infinity, max: -Infinity };
    this.show();
  }

  /** The values to come are of another scene. */
  forget(): void {
    this.auto = new AutoRange(isDiverging(this.settings?.map ?? 'viridis'));
  }

  private show(): void {
    const { colour = 'body', map = 'viridis', from, to } = this.settings ?? {};
    const { min, max } = this.auto.range;
    const isFixed = from !== undefined && to !== undefined && from < to;
    const range = isFixed ? { min: from, max: to } : { min, max };
    this.uniforms.value_range.value.set(range.min, range.max);
    const quantity = quantityOf(colour);
    const meaning = quantity && { quantity, map, range };
    for (const tell of this.listeners) tell(meaning);
  }
}
