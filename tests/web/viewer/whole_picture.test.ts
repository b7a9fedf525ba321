import { expect, it, vi } from 'vitest';
import type { FrameHeader } from '../../../web/client/index';
import { WholePicture } from '../../../web/viewer/panel/status/whole_picture';

const header = (change: Partial<FrameHeader>): FrameHeader =>
  ({ tick: 7, stride: 1, detail: 3, ...change }) as FrameHeader;

it.each([
  ['of all particles', {}, false, 0],
  ['of fewer particles', { detail: 0 }, false, 1],
  ['that comes rarely', { stride: 4 }, false, 1],
  ['while it plays', { detail: 0 }, true, 0],
  ['of an earlier tick, equal to the present one', { detail: 0, tick: 6 }, false, 1],
  ['of an earlier tick and of all particles', { tick: 6 }, false, 0],
])('requests the whole picture once at rest: one %s', (_, change, playing, count) => {
  const ask = vi.fn();
  const whole = new WholePicture(ask);
  whole.showFrame(header(change));
  for (let n = 0; n < 3; ++n) whole.showStatus({ playing, tick: 7 });
  expect(ask).toHaveBeenCalledTimes(count);
});

it('requests it again at each rest', () => {
  const ask = vi.fn();
  const whole = new WholePicture(ask);
  whole.showFrame(header({ detail: 1 }));
  for (const playing of [false, true, false]) whole.showStatus({ playing, tick: 7 });
  expect(ask).toHaveBeenCalledTimes(2);
});

it('requests it again for another scene at the same tick', () => {
  const ask = vi.fn();
  const whole = new WholePicture(ask);
  for (const epoch of [1, 2]) {
    whole.showFrame(header({ detail: 1, epoch }));
    whole.showStatus({ playing: false, tick: 7 });
  }
  expect(ask).toHaveBeenCalledTimes(2);
});

it('waits for a frame that is on its way', () => {
  const ask = vi.fn();
  const whole = new WholePicture(ask);
  whole.showFrame(header({ detail: 0, tick: 6 }));
  whole.showStatus({ playing: false, tick: 7 });
  expect(ask).not.toHaveBeenCalled();
  whole.showFrame(header({ tick: 7 }));
  whole.showStatus({ playing: false, tick: 7 });
  expect(ask).not.toHaveBeenCalled();
});
