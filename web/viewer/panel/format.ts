/** Formats of the panel's numbers. */

const kThinSpace = '\u202f';

/** Formats an integer with separated thousands. */
export function formatCount(count: number): string {
  return Math.round(count)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, kThinSpace);
}

export function formatSeconds(seconds: number): string {
  return `${seconds.toFixed(2)} s`;
}

/** Formats a factor of real time. */
export function formatFactor(factor: number): string {
  return `${factor.toFixed(2)} ×`;
}

export function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${Math.round(bytes)} B`;
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(1)} kB`;
  return `${(bytes / 1e6).toFixed(2)} MB`;
}

export function formatMilliseconds(seconds: number): string {
  return `${Math.round(1000 * seconds)} ms`;
}

/** Formats a relative error with two digits. */
export function formatError(error: number): string {
  return `${Number((100 * error).toPrecision(2))} %`;
}

/** Formats a small length [m] with two digits. */
export function formatLength(metres: number): string {
  const millimetres = 1000 * metres;
  if (millimetres >= 0.1) return `${Number(millimetres.toPrecision(2))} mm`;
  return `${Number((1000 * millimetres).toPrecision(2))} µm`;
}

export function formatMass(kilogrammes: number): string {
  if (kilogrammes >= 1) return `${Number(kilogrammes.toPrecision(3))} kg`;
  const grammes = 1000 * kilogrammes;
  if (grammes >= 0.1) return `${Number(grammes.toPrecision(3))} g`;
  return `${Number((1000 * grammes).toPrecision(3))} mg`;
}
