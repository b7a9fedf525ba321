/** The distributions of residuals: protocol/FRAMES.md, "Residuals". */

export const kTables = 24;
export const kClasses = 68;
export const kLeastKeyClass = 14;
/** All probabilities are multiples of 1 / 4096. */
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

function partBelow(eighths: number, steepness: number): number {
  const steps = Math.abs(eighths) * steepness;
  const index = Math.min(steps >> 8, 80);
  const low = kLogistic[index] ?? 0;
  const part = low + ((((kLogistic[index + 1] ?? 0) - low) * (steps & 255)) >> 8);
  return eighths < 0 ? 65536 - part : part;
}

/** Elements of `kCases` contain the number of low bits, the table, and the position in it. */
const kPlaces = 2;
export const kTableBits = 8;
/** A slot is a state modulo 2 ** 12. The residuals of a table are stored modulo 2 ** 6. */
export const kSlotBits = 12;
export const kResidualBits = 6;
/** The escape symbol; modulo 2 ** 6 it differs from all residuals of a table. */
export const kEscape = 32;
const kResidualMask = (1 << kResidualBits) - 1;

/** By class and fraction (8 values from -4): low bits << 8 | table and position. */
export const kCases = Uint16Array.from({ length: 8 * kClasses }, (_, k) => {
  const c = k >> 3;
  const lowBits = c < kTables ? 0 : 1 + ((c - kTables) >> 2);
  const table = c < kTables ? c : kTables - 4 + ((c - kTables) & 3);
  const place = Math.abs((k & 7) - 4) >= 2 ? 1 : 0;
  return (lowBits << kTableBits) | (kPlaces * table + place);
});

/**
 * Returns, by table and position, the residual of each slot or kEscape; and its frequency and start,
 * 16 bits each.
 */
function makeTables(): { residuals: Int8Array; ranges: Int32Array } {
  const residuals = new Int8Array((kPlaces * kTables) << kSlotBits);
  const ranges = new Int32Array((kPlaces * kTables) << kResidualBits);
  for (let index = 0; index < kPlaces * kTables; ++index) {
    const radius = kRadius[index >> 1] ?? 0;
    const count = 2 * radius + 2;
    const below = (residual: number) =>
      partBelow(8 * residual - 4 - (kMiddle[index & 1] ?? 0), kSteepness[index >> 1] ?? 0);
    const startOf = (k: number) =>
      k === count ? kScale : k + (((below(k - radius) - below(-radius)) * (kScale - count)) >> 16);
    for (let k = 0; k < count; ++k) {
      const [start, end] = [startOf(k), startOf(k + 1)];
      const residual = k === count - 1 ? kEscape : k - radius;
      ranges[(index << kResidualBits) | (residual & kResidualMask)] = ((end - start) << 16) | start;
      residuals.fill(residual, kScale * index + start, kScale * index + end);
    }
  }
  return { residuals, ranges };
}

export const { residuals: kResiduals, ranges: kRanges } = makeTables();
