/** Times the decoder in a browser's worker: receives a stream and posts its times. */
import { decodeTimes } from './decode_times';

self.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => self.postMessage(decodeTimes(data));
