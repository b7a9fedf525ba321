import { emptyFrame, FrameDecoder } from '../client/index';

/** Decoding times of frames [ms]: those with two references, and key frames. */
export interface DecodeTimes {
  deltas: number[];
  keys: number[];
}

/** In the first rounds, V8 has not compiled all frequently used code. */
const kWarmUpRounds = 2;
const kRounds = 3;

/** Decodes a stream of `vat bench codec` repeatedly, as a viewer would. */
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

/** Returns the frames. Each follows the number of its bytes. */
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

/**
 * Returns the times to which the frame's time is added; none for the one frame with one reference.
 */
function timesLike(frame: ArrayBuffer, { deltas, keys }: DecodeTimes): number[] | undefined {
  const view = new DataView(frame);
  if (view.getUint8(5) === 1) return keys;
  return view.getUint16(18, true) > 0 ? deltas : undefined;
}
