/** Width and height [px]. */
export interface Size {
  width: number;
  height: number;
}

/** Sizes of photos beside that of the picture on the page. The last is the greatest. */
export const kSizes: readonly Size[] = [
  { width: 1920, height: 1080 },
  { width: 3840, height: 2160 },
];

/** The stage that draws photos. */
export interface Photographer {
  readonly canvas: HTMLCanvasElement;
  /** Draws the picture at this size. `use` must read the canvas immediately. */
  drawAt(size: Size, use: () => void): void;
}

/**
 * Returns a picture of this size as PNG.
 * @throws Error if the graphics cannot draw this size.
 */
export function photograph(stage: Photographer, size: Size): Promise<Blob> {
  return new Promise((resolve, reject) => {
    stage.drawAt(size, () => {
      stage.canvas.toBlob((file) => {
        if (file) resolve(file);
        else reject(new Error('the browser cannot store a picture of this size'));
      }, 'image/png');
    });
  });
}
