import type { ViewSettings } from '../base/settings';
import type { LookUniforms } from './look_uniforms';
import { fillMapTexture, isDiverging } from './maps';
import { quantityOf } from './quantity';
import type { QuantityName } from './quantity';
import { AutoRange } from './range';
import type { Range } from './range';

/** The present meaning of colours. */
export interface Meaning {
  quantity: QuantityName;
  map: ViewSettings['map'];
  range: Range;
}

/** The colour scale: a map, and the values at its ends, fixed or automatic. */
export class ColourScale {
  private settings: Pick<ViewSettings, 'colour' | 'map' | 'from' | 'to'> | undefined;
  private auto = new AutoRange(false);
  private frame: Range = { min: Infinity, max: -Infinity };
  private readonly listeners: ((meaning: Meaning | undefined) => void)[] = [];

  constructor(private readonly uniforms: LookUniforms) {}

  /** Notifies a listener after each change of the meaning; undefined: colours show no numbers. */
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

  /** Adds the range of one body of a frame. */
  add({ min, max }: Range): void {
    this.frame.min = Math.min(this.frame.min, min);
    this.frame.max = Math.max(this.frame.max, max);
  }

  /** Updates the scale after the last body of a frame. */
  settle(): void {
    if (!this.settings || !quantityOf(this.settings.colour)) return;
    this.auto.add(this.frame);
    this.frame = { min: Infinity, max: -Infinity };
    this.show();
  }

  /** Resets the automatic range for another scene. */
  forget(): void {
    this.auto = new AutoRange(isDiverging(this.settings?.map ?? 'viridis'));
  }

  private show(): void {
    const { colour = 'material', map = 'viridis', from, to } = this.settings ?? {};
    const { min, max } = this.auto.range;
    const isFixed = from !== undefined && to !== undefined && from < to;
    const range = isFixed ? { min: from, max: to } : { min, max };
    this.uniforms.value_range.value.set(range.min, range.max);
    const quantity = quantityOf(colour);
    const meaning = quantity && { quantity, map, range };
    for (const tell of this.listeners) tell(meaning);
  }
}
