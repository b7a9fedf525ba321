/** Time until the memory of a saved file is released [ms]; browsers read it after the click. */
const kReleaseMs = 60_000;

/** Offers a file to the user as a download. */
export function save(file: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), kReleaseMs);
}

/** Returns the name of a file for a scene at a simulated time [s]. */
export function fileName(scene: string, time: number, extension: string): string {
  const plain = scene.replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '') || 'scene';
  return `vat-${plain}-${time.toFixed(2)}s.${extension}`;
}
