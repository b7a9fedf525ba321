/** Formats of videos, the best first. */
const kTypes = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

/** Bits per second; moving liquids have many edges. */
const kBitsPerSecond = 12e6;

/** The interval in which the browser returns parts of the video [ms]. */
const kPartMs = 1000;

/** The maximum duration [s], because the video is in memory until it is saved. */
export const kMostSeconds = 600;

/** Returns the format in which this browser records videos; undefined if it cannot. */
export function videoType(): string | undefined {
  if (typeof MediaRecorder === 'undefined') return undefined;
  if (!('captureStream' in HTMLCanvasElement.prototype)) return undefined;
  return kTypes.find((type) => MediaRecorder.isTypeSupported(type));
}

/** A running recording of the pictures on a canvas. */
export class VideoRecording {
  private readonly parts: Blob[] = [];
  private readonly recorder: MediaRecorder;
  private readonly ended: Promise<Blob>;

  /** `type` is a result of videoType(). */
  constructor(canvas: HTMLCanvasElement, type: string) {
    const stream = canvas.captureStream();
    this.recorder = new MediaRecorder(stream, {
      mimeType: type,
      videoBitsPerSecond: kBitsPerSecond,
    });
    this.recorder.ondataavailable = ({ data }) => this.parts.push(data);
    this.ended = new Promise((resolve, reject) => {
      this.recorder.onstop = () => {
        for (const track of stream.getTracks()) track.stop();
        resolve(new Blob(this.parts, { type: 'video/webm' }));
      };
      this.recorder.onerror = () => reject(new Error('the browser has ended the video'));
    });
    this.recorder.start(kPartMs);
  }

  /** Ends the recording and returns the file. */
  stop(): Promise<Blob> {
    if (this.recorder.state !== 'inactive') this.recorder.stop();
    return this.ended;
  }
}
