import { element, onPress } from '../elements';

/** The inclination of a device [degrees]: to the right, and of its top away from the user. */
export interface Lean {
  right: number;
  away: number;
}

/** The function of browsers that require the user's permission. */
interface Asking {
  requestPermission?: () => Promise<'granted' | 'denied'>;
}

/** Without an event for this time, the device has no sensor [ms]. */
const kSilenceMs = 2000;

/** Converts to the axes of the rotated screen. Sensors use the axes of the device. */
export function leanOf(beta: number, gamma: number, screenAngle: number): Lean {
  switch (screenAngle) {
    case 90:
      return { right: beta, away: gamma };
    case 270:
      return { right: -beta, away: -gamma };
    case 180:
      return { right: -gamma, away: beta };
    default:
      return { right: gamma, away: -beta };
  }
}

/** Tilts gravity with the device, relative to its inclination when the function is enabled. */
export class DeviceTilt {
  private readonly button = element('gravity-device', HTMLButtonElement);
  private start: Lean | undefined;
  private isOn = false;
  private silence: number | undefined;
  private readonly listener = (event: DeviceOrientationEvent): void => this.take(event);

  constructor(
    private readonly tilt: (lean: Lean) => void,
    private readonly fail: (words: string) => void,
  ) {
    this.button.hidden = !matchMedia('(pointer: coarse)').matches;
    onPress(this.button, () => (this.isOn ? this.stop() : void this.begin()));
  }

  enable(enabled: boolean): void {
    this.button.disabled = !enabled;
    if (!enabled) this.stop();
  }

  private async begin(): Promise<void> {
    if (!('DeviceOrientationEvent' in window)) {
      return this.fail('Device orientation needs a secure page. Open the page with https.');
    }
    const { requestPermission } = DeviceOrientationEvent as Asking;
    const answer = (await requestPermission?.().catch(() => 'denied')) ?? 'granted';
    if (answer !== 'granted') {
      return this.fail('The browser blocks the device orientation. Allow it in the browser.');
    }
    this.isOn = true;
    this.start = undefined;
    this.button.ariaPressed = 'true';
    window.addEventListener('deviceorientation', this.listener);
    this.silence = window.setTimeout(() => {
      this.stop();
      this.fail('This device does not report its orientation.');
    }, kSilenceMs);
  }

  private stop(): void {
    this.isOn = false;
    this.button.ariaPressed = 'false';
    window.clearTimeout(this.silence);
    window.removeEventListener('deviceorientation', this.listener);
  }

  private take({ beta, gamma }: DeviceOrientationEvent): void {
    if (beta === null || gamma === null) return; // a device without the sensor
    window.clearTimeout(this.silence);
    const lean = leanOf(beta, gamma, window.screen.orientation.angle);
    this.start ??= lean;
    this.tilt({ right: lean.right - this.start.right, away: lean.away - this.start.away });
  }
}
