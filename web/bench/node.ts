/** Times the decoder in Node: prints the times of the stream in its first argument. */
import { readFileSync } from 'node:fs';
import { decodeTimes } from './decode_times';

const stream = new Uint8Array(readFileSync(process.argv[2] ?? '')).buffer;
process.stdout.write(JSON.stringify(decodeTimes(stream)));
