import { emptyFrame, FrameDecoder } from '../client/index';

/** How long frames took to decode [ms]: those with two references, and key frames. */
export interface DecodeTimes {
  deltas: number[];
  keys: number[];
}

/** At first V8 has not compiled all that is used often. */
const kWarmUpRounds = 2;
const kRounds = 3;

/** Decodes a stream, as `vat bench codec` writes it, again and again as a viewer would. */
export function decodeTimes(stream: ArrayBuffer): DecodeTimes {
  const frames = framesOf(stream);
  const decoder = new FrameDecoder();
  const into = emptyFrame();
  const times: DecodeTimes = { deltas: [], keys: [] };
  for (let round = 0; round < kWarmUpRounds + kRounds; ++round) {
    for (const bytes of frames) {
      const begin = performance.now();
      decoder.decode(bytes, into);
      const taken = performance.now() - begin;
      if (round >= kWarmUpRounds) timesLike(bytes, times)?.push(taken);
    }
  }
  return times;
}

/** Each is behind the number of its bytes. */
function framesOf(stream: ArrayBuffer): ArrayBuffer[] {
  const view = new DataView(stream);
  const frames: ArrayBuffer[] = [];
  for (let at = 0; at < stream.byteLength;) {
    const begin = at + 4;
    at = begin + view.getUint32(at, true);
    frames.push(stream.slice(begin, at));
  }
  return frames;
}

/** Those that this frame's time belongs to; none for the one frame with one reference. */
function timesLike(frame: ArrayBuffer, { deltas, keys }: DecodeTimes): number[] | undefined {
  const view = new DataView(frame);
  if (view.getUint8(5) === 1) return keys;
  return view.getUint16(18, true) > 0 ? deltas : undefined;
}
