import { make } from '../panel/elements';
import { profileInWords } from './stage_words';
import type { TickProfile } from './stage_words';

const kColours = ['#3f87d9', '#e08a3c', '#3aa876', '#a86cc9', '#d4577a', '#8f9a45', '#5f8f9c'];
const kRest = '#8a96a3';

/** Smaller shares are combined. */
const kLeastShare = 0.02;

/** The computing time of a tick by stage, as a bar and as text. */
export class StageBar {
  readonly element: HTMLElement;
  private readonly bar = make('div', { id: 'stage-bar', ariaHidden: 'true' });
  private readonly list = make('ul', { id: 'stage-list' });
  private readonly words = make('p', { id: 'stage-words', className: 'soft' });

  constructor() {
    this.element = make('figure', { className: 'curve' });
    const title = make('figcaption', {}, make('b', {}, 'Computing time'));
    this.element.append(title, this.words, this.bar, this.list);
    this.show(undefined, 1, 1);
  }

  show(profile: TickProfile | undefined, tickSeconds: number, speed: number): void {
    if (!profile) {
      this.words.textContent = 'The session is paused. Computing times appear while it plays.';
      return;
    }
    this.words.textContent = profileInWords(profile, tickSeconds, speed);
    const named = profile.parts.filter(({ share }) => share >= kLeastShare);
    const rest = 1 - named.reduce((sum, { share }) => sum + share, 0);
    const parts = [
      ...named.map(({ words, share }, n) => ({ words, share, colour: kColours[n] ?? kRest })),
      ...(rest > 0.005 ? [{ words: 'the rest', share: rest, colour: kRest }] : []),
    ];
    this.bar.replaceChildren(
      ...parts.map(({ share, colour }) => {
        const piece = make('i');
        piece.style.flexGrow = String(share);
        piece.style.background = colour;
        return piece;
      }),
    );
    this.list.replaceChildren(
      ...parts.map(({ words, share, colour }) => {
        const dot = make('i');
        dot.style.background = colour;
        return make('li', {}, dot, words, make('span', {}, `${Math.round(100 * share)} %`));
      }),
    );
  }
}
