import { Color } from 'three';
import './theme.css';

/** Colours of the surroundings. */
export interface Theme {
  /** The ground and the sky far from the scene. */
  stage: Color;
  /** The ground below the scene. */
  ground: Color;
  /** The sky above the horizon. */
  sky: Color;
  floor: Color;
  shadow: Color;
  grid: Color;
  edge: Color;
  wall: Color;
  /** Arrows. */
  mark: Color;
}

const kProperties: Readonly<Record<keyof Theme, string>> = {
  stage: '--view-stage',
  ground: '--view-ground',
  sky: '--view-sky',
  floor: '--view-floor',
  shadow: '--view-shadow',
  grid: '--view-grid',
  edge: '--view-edge',
  wall: '--view-wall',
  mark: '--view-mark',
};

/** Returns the theme of an element's style, light or dark. */
export function readTheme(element: Element): Theme {
  const probe = document.createElement('i');
  element.append(probe);
  const read = (property: string): Color => {
    probe.style.color = `var(${property})`;
    return new Color(getComputedStyle(probe).color);
  };
  const names = Object.keys(kProperties) as (keyof Theme)[];
  const theme = Object.fromEntries(names.map((name) => [name, read(kProperties[name])]));
  probe.remove();
  return theme as Record<keyof Theme, Color>;
}

/** Notifies of possible changes of the page's style, by the system or by the page's switch. */
export function watchTheme(onChange: () => void): void {
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', onChange);
  new MutationObserver(onChange).observe(document.documentElement, { attributes: true });
}
