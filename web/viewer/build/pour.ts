import { Vector3 } from 'three';
import type { Scene, SceneBody, SceneEmitter, SessionDescription } from '../../client/index';
import { element, make, makeButton } from '../panel/elements';
import type { Keys } from '../panel/keys';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import type { World } from '../view/world';
import { placeFor } from './room';
import type { SceneDocument } from './scene_document';

/** The interval of drops while the button is held [ms]. */
const kPeriodMs = 450;

/** A drop's radius divided by its spacing. */
const kDropInSpacings = 2.4;

/** The initial downward speed [m/s]. */
const kDropSpeed = 0.8;

/** Pours liquid: through the scene's emitters, and as drops if the scene has a liquid. */
export class Pour {
  private readonly row = element('pour-row', HTMLElement);
  private readonly drop = makeButton('Pour', () => undefined);
  private scene: Scene | undefined;
  private description: SessionDescription | undefined;
  private isEnabled = false;
  private timer: number | undefined;
  private isBusy = false;
  /** Whether a drop was added that no description contains yet. */
  private isAwaited = false;
  private poured = 0;

  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
    private readonly world: World,
    keys: Keys,
  ) {
    const { drop } = this;
    drop.id = 'pour';
    drop.title = 'Pours a drop of liquid; hold for more';
    drop.addEventListener('pointerdown', ({ button }) => button === 0 && this.begin());
    for (const type of ['pointerup', 'pointercancel', 'pointerleave', 'blur'] as const) {
      drop.addEventListener(type, () => this.end());
    }
    // A click by keyboard adds one drop.
    drop.addEventListener('click', ({ detail }) => detail === 0 && void this.pour());
    keys.add({
      keys: ['p'],
      sign: 'P',
      words: 'pour a drop',
      repeats: true,
      act: () => void this.pour(),
      isEnabled: () => !this.row.hidden && !this.drop.hidden && this.isEnabled,
    });
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.isAwaited = false;
    for (const button of this.row.querySelectorAll('button')) button.disabled = !enabled;
    if (enabled && this.row.hidden) void this.look();
    if (enabled) return;
    this.end();
    this.row.hidden = true;
  }

  /** `isEarlier`: a reset, which also resets emitters, or a saved state. */
  describe(description: SessionDescription, isEarlier: boolean): void {
    const before = this.description;
    this.description = description;
    this.isAwaited = false;
    // Each change of gravity and each drop also sends a description.
    if (isEarlier || !before || liquidsOf(description) !== liquidsOf(before)) void this.look();
  }

  /** Requests the scene, which defines the available liquids. */
  private async look(): Promise<void> {
    const scene = await this.document.get();
    if (this.description?.replay || !this.isEnabled) return;
    this.scene = scene;
    this.drop.hidden = this.example === undefined;
    const taps = (scene?.emitters ?? []).map((emitter) => this.tap(emitter));
    const focused = taps.find(({ dataset }) => dataset.emitter === this.focusedTap);
    const isUnfolded = this.row.querySelector('details')?.open ?? false;
    this.row.replaceChildren(...foldedWhereMany(taps, isUnfolded), this.drop);
    focused?.focus();
    this.row.hidden = taps.length === 0 && this.drop.hidden;
  }

  private get focusedTap(): string | undefined {
    const { activeElement } = document;
    return activeElement instanceof HTMLElement ? activeElement.dataset.emitter : undefined;
  }

  /** An existing body of the poured liquid. */
  private get example(): SceneBody | undefined {
    return this.scene?.bodies.find(
      ({ kind, spacing }) => kind === 'liquid' && spacing !== undefined,
    );
  }

  private tap({ name, open = true }: SceneEmitter): HTMLButtonElement {
    const button = makeButton(`${open ? 'Close' : 'Open'} ${name}`, () => {
      void ask(this.desk, 'world.set_emitter', { emitter: name, open: !open }).then(() => {
        this.document.forget();
        return this.look();
      });
    });
    button.dataset.emitter = name;
    button.ariaPressed = String(open);
    button.disabled = !this.isEnabled;
    return button;
  }

  private begin(): void {
    this.end();
    void this.pour();
    this.timer = window.setInterval(() => void this.pour(), kPeriodMs);
  }

  private end(): void {
    window.clearInterval(this.timer);
    this.timer = undefined;
  }

  /** Whether the previous drop is displayed, so that the next one does not overlap it. */
  private get isReady(): boolean {
    const isDrawn = element('view', HTMLCanvasElement).dataset.tick !== undefined;
    return this.isEnabled && !this.isBusy && !this.isAwaited && isDrawn;
  }

  /** Adds one drop. Ignores requests while another is pending. */
  private async pour(): Promise<void> {
    const { example } = this;
    if (!example || !this.isReady) return;
    const spacing = example.spacing!;
    const radius = kDropInSpacings * spacing;
    const place = placeFor(this.world, radius + spacing / 2);
    if (!place) {
      this.end();
      return this.desk.say('There is no room at the top. Pour again later.');
    }
    this.isBusy = this.isAwaited = true;
    const body = this.dropAt(place, example, radius);
    const done = await ask(this.desk, 'world.add_body', { body });
    this.isBusy = false;
    if (done) return;
    this.isAwaited = false;
    this.end();
  }

  private dropAt(place: Vector3, { material, spacing }: SceneBody, radius: number): SceneBody {
    const names = new Set(this.description?.bodies.map(({ name }) => name));
    do this.poured += 1;
    while (names.has(`drop ${this.poured}`));
    return {
      name: `drop ${this.poured}`,
      kind: 'liquid',
      material,
      spacing: spacing!,
      shape: { type: 'sphere', radius },
      position: [place.x, place.y, place.z],
      velocity: [0, 0, -kDropSpeed],
    };
  }
}

/** The maximum number of displayed emitters. */
const kMostTaps = 4;

function foldedWhereMany(taps: readonly HTMLElement[], open: boolean): readonly HTMLElement[] {
  if (taps.length <= kMostTaps) return taps;
  const places = make('div', { className: 'taps' }, ...taps);
  return [make('details', { open }, make('summary', {}, `${taps.length} taps`), places)];
}

/** Returns a key that changes with the available liquids. */
function liquidsOf({ session, scene, bodies }: SessionDescription): string {
  const liquids = bodies.filter(({ kind }) => kind === 'liquid').map(({ material }) => material);
  return JSON.stringify([session, scene, [...new Set(liquids)]]);
}
