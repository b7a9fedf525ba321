/** How residuals are distributed: protocol/PROTOCOL.md, "Residuals". */

export const kTables = 24;
export const kClasses = 68;
export const kLeastKeyClass = 14;
/** Of 4096 parts, by which all probabilities are counted. */
export const kScale = 4096;

// 65536 / (1 + exp(-k / 8)).
// prettier-ignore
const kLogistic = [
  32768, 34813, 36843, 38841, 40793, 42687, 44511, 46254, 47911, 49474, 50941, 52310, 53581,
  54754, 55834, 56822, 57724, 58544, 59287, 59959, 60565, 61109, 61598, 62036, 62428, 62778,
  63090, 63368, 63615, 63835, 64030, 64203, 64357, 64494, 64614, 64721, 64816, 64900, 64974,
  65039, 65097, 65149, 65194, 65234, 65269, 65300, 65328, 65352, 65374, 65393, 65410, 65425,
  65438, 65449, 65459, 65468, 65476, 65483, 65489, 65495, 65500, 65504, 65508, 65511, 65514,
  65517, 65519, 65521, 65523, 65524, 65526, 65527, 65528, 65529, 65530, 65530, 65531, 65532,
  65532, 65533, 65533, 65533,
];
// prettier-ignore
const kSteepness = [
  5689, 4784, 4023, 3383, 2844, 2392, 2011, 1691, 1422, 1196, 1006, 846, 711, 598, 503, 423,
  356, 299, 251, 211, 178, 149, 126, 106,
];
export const kRadius = [
  2, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 5, 6, 7, 7, 9, 10, 12, 13, 16, 18,
];
const kMiddle = [1, 3];

/** Room for the starts of one table: its symbols, and the end. */
export const kStarts = 40;

function partBelow(eighths: number, steepness: number): number {
  const steps = Math.abs(eighths) * steepness;
  const index = Math.min(steps >> 8, 80);
  const low = kLogistic[index] ?? 0;
  const part = low + ((((kLogistic[index + 1] ?? 0) - low) * (steps & 255)) >> 8);
  return eighths < 0 ? 65536 - part : part;
}

/** By table and place: the symbol of each slot, and where each symbol starts. */
function makeTables(): { symbols: Uint8Array; starts: Uint16Array } {
  const symbols = new Uint8Array(2 * kTables * kScale);
  const starts = new Uint16Array(2 * kTables * kStarts);
  for (let t = 0; t < kTables; ++t) {
    for (let place = 0; place < 2; ++place) {
      const radius = kRadius[t] ?? 0;
      const count = 2 * radius + 2;
      const first = (2 * t + place) * kStarts;
      const below = (residual: number) =>
        partBelow(8 * residual - 4 - (kMiddle[place] ?? 0), kSteepness[t] ?? 0);
      for (let k = 0; k < count; ++k) {
        const part = below(k - radius) - below(-radius);
        starts[first + k] = k + ((part * (kScale - count)) >> 16);
      }
      starts[first + count] = kScale;
      const slots = (2 * t + place) * kScale;
      for (let k = 0; k < count; ++k) {
        symbols.fill(k, slots + (starts[first + k] ?? 0), slots + (starts[first + k + 1] ?? 0));
      }
    }
  }
  return { symbols, starts };
}

export const { symbols: kSymbols, starts: kSymbolStarts } = makeTables();
