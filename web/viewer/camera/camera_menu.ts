import { kSizes, photograph } from '../capture/photo';
import type { Photographer, Size } from '../capture/photo';
import { fileName, save } from '../capture/save';
import { kMostSeconds, VideoRecording, videoType } from '../capture/video';
import { make, makeButton } from '../panel/elements';
import { kPresets } from '../view/base/presets';
import type { Preset } from '../view/base/presets';
import './camera.css';

/** The page's functions that the menu uses. */
export interface MenuActions {
  readonly stage: Photographer & { invalidate(): void; readonly size: Size };
  show(preset: Preset): void;
  follow(body: number | undefined): void;
  /** The followed body, and the bodies of the scene. */
  readonly followed: number | undefined;
  readonly bodies: readonly { body: number; name: string }[];
  /** The scene's name and the simulated time [s]. */
  readonly moment: { scene: string; time: number };
  /** Opens the dialog for links; undefined if there is nothing to link to. */
  readonly share: (() => void) | undefined;
}

const kWords: Readonly<Record<Preset, string>> = {
  front: 'Front',
  side: 'Side',
  top: 'Top',
  corner: 'Corner',
};

/** The interval of the video's displayed time [ms]. */
const kPeriodMs = 500;

/** The menu for the camera, photos, videos and links. */
export class CameraMenu {
  private readonly body = make('select', { id: 'camera-follow' });
  private readonly size = make('select', { id: 'photo-size', ariaLabel: 'Size of photos' });
  private readonly photo = makeButton('Photo', () => void this.takePhoto());
  private readonly video = makeButton('Record video', () => void this.toggleVideo());
  private readonly link = makeButton('Link', () => this.actions.share?.());
  private readonly words = make('p', { id: 'camera-words', className: 'soft', role: 'status' });
  private recording: VideoRecording | undefined;
  private timer: number | undefined;

  constructor(
    menu: HTMLElement,
    private readonly actions: MenuActions,
  ) {
    this.photo.id = 'photo';
    this.video.id = 'video';
    this.link.id = 'camera-link';
    this.link.title = 'A link to this moment with camera and view settings';
    const presets = kPresets.map((preset) => {
      const button = makeButton(kWords[preset], () => actions.show(preset));
      button.dataset.preset = preset;
      return button;
    });
    this.body.addEventListener('change', () => {
      actions.follow(this.body.value === '' ? undefined : Number(this.body.value));
    });
    const views = make('div', { className: 'row', role: 'group', ariaLabel: 'View from' });
    views.append(...presets);
    menu.append(
      views,
      make('label', { className: 'row' }, 'Follow', this.body),
      make('div', { className: 'row' }, this.size, this.photo),
      make('div', { className: 'row' }, this.video, this.link),
      this.words,
    );
    if (videoType() === undefined) {
      this.video.disabled = true;
      this.words.textContent = 'This browser cannot record WebM videos.';
    }
  }

  /** Shows the present bodies and sizes. Called before the menu opens. */
  refresh(): void {
    const { followed, bodies, stage, share } = this.actions;
    this.body.replaceChildren(
      new Option('nothing', ''),
      ...bodies.map(({ body, name }) => new Option(name, String(body))),
    );
    this.body.value = String(followed ?? '');
    const chosen = Math.max(this.size.selectedIndex, 0);
    const sizes = [stage.size, ...kSizes];
    this.size.replaceChildren(
      ...sizes.map((size, i) => new Option(inWords(size) + (i === 0 ? ' (page)' : ''), String(i))),
    );
    this.size.selectedIndex = chosen;
    this.link.disabled = share === undefined;
  }

  private get chosenSize(): Size {
    return kSizes[this.size.selectedIndex - 1] ?? this.actions.stage.size;
  }

  private async takePhoto(): Promise<void> {
    const { stage, moment } = this.actions;
    const size = this.chosenSize;
    this.photo.disabled = true;
    try {
      const name = fileName(moment.scene, moment.time, 'png');
      save(await photograph(stage, size), name);
      this.words.textContent = `Saved ${name}, ${inWords(size)}.`;
    } catch (error) {
      this.words.textContent = `No photo: ${reasonOf(error)}.`;
    } finally {
      this.photo.disabled = false;
    }
  }

  private async toggleVideo(): Promise<void> {
    if (this.recording) await this.finishVideo(this.recording);
    else this.beginVideo();
  }

  private beginVideo(): void {
    const type = videoType();
    if (type === undefined) return;
    const { stage } = this.actions;
    this.recording = new VideoRecording(stage.canvas, type);
    stage.invalidate(); // a paused scene is drawn once
    const begin = performance.now();
    const show = (): void => {
      const seconds = Math.floor((performance.now() - begin) / 1000);
      this.video.textContent = `Save video (${seconds} s)`;
      if (seconds >= kMostSeconds) void this.toggleVideo();
    };
    show();
    this.timer = window.setInterval(show, kPeriodMs);
    this.video.ariaPressed = 'true';
    this.words.textContent = 'The video has the picture without the controls.';
  }

  private async finishVideo(recording: VideoRecording): Promise<void> {
    window.clearInterval(this.timer);
    this.recording = undefined;
    this.video.ariaPressed = 'false';
    this.video.textContent = 'Record video';
    const { scene, time } = this.actions.moment;
    try {
      const name = fileName(scene, time, 'webm');
      save(await recording.stop(), name);
      this.words.textContent = `Saved ${name}.`;
    } catch (error) {
      this.words.textContent = `No video: ${reasonOf(error)}.`;
    }
  }
}

function inWords({ width, height }: Size): string {
  return `${width} × ${height}`;
}

function reasonOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
