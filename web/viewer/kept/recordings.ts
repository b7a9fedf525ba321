import { isCommandRecording, RequestError } from '../../client/index';
import { element, make, makeButton } from '../panel/elements';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { faultOfRecording, sendRecording } from './recording_file';

export interface RecordingActions {
  /** Switches to the session of a replay. */
  go(session: string): void;
  /** Plays a recording of frames. */
  play(file: File): void;
}

/** Recordings: the session's as a file or a replay, and replays of files. */
export class Recordings {
  private readonly exporter = makeButton('Download', () => void this.export());
  private readonly watcher = makeButton('Replay this session', () => void this.openOwn());
  private readonly opener = makeButton('Open a recording', () => this.input.click());
  private readonly input = make('input', {
    type: 'file',
    accept: '.vatrec',
    id: 'recording-input',
    hidden: true,
  });
  private readonly note = make('p', { id: 'recording-note', className: 'soft' });
  private records = true;
  private isLive = false;
  private readonly progress = make('p', { id: 'recording-progress', className: 'soft' });

  constructor(
    private readonly desk: Desk,
    private readonly session: () => string,
    private readonly actions: RecordingActions,
  ) {
    this.exporter.id = 'recording-export';
    this.watcher.id = 'recording-watch';
    this.opener.id = 'recording-open';
    this.progress.role = 'status';
    this.input.addEventListener('change', () => {
      void this.open(this.input.files?.[0]);
      this.input.value = ''; // allows the same file to be chosen again
    });
    const own = make('div', { className: 'row' }, this.exporter, this.watcher);
    const other = make('div', { className: 'row' }, this.opener);
    const title = make('h3', {}, 'Recordings');
    element('kept-place', HTMLElement).append(
      title,
      this.note,
      own,
      other,
      this.input,
      this.progress,
    );
    this.enable(false, false);
  }

  /** Enables recording. `isReplay`: the session is a replay. */
  enable(enabled: boolean, isReplay: boolean): void {
    this.isLive = enabled && !isReplay;
    this.opener.disabled = !enabled;
    this.write();
  }

  /** Shows whether the server records its sessions. */
  showServer(records: boolean): void {
    this.records = records;
    this.write();
  }

  private write(): void {
    this.exporter.disabled = this.watcher.disabled = !this.isLive || !this.records;
    this.note.textContent = this.records
      ? 'The server records this session.'
      : 'This server does not record sessions. To record, start it with --data FOLDER.';
  }

  private async export(): Promise<void> {
    const made = await ask(this.desk, 'recording.export', {});
    if (!made) return;
    make('a', { href: made.path, download: '' }).click();
  }

  private async openOwn(): Promise<void> {
    const opened = await ask(this.desk, 'replay.open', { session: this.session() });
    if (opened) this.actions.go(opened.session);
  }

  /** Opens a file: plays its frames, or sends its commands to the server, which replays them. */
  async open(file: File | undefined): Promise<void> {
    if (!file) return;
    if (isCommandRecording(await file.slice(0, 8).arrayBuffer())) await this.import(file);
    else this.actions.play(file);
  }

  private async import(file: File): Promise<void> {
    const fault = faultOfRecording(file.name, file.size);
    if (fault !== undefined) return this.desk.fail(fault);
    try {
      const recording = await sendRecording(file, this.desk.request, (share) => {
        this.progress.textContent = `Sending “${file.name}”: ${Math.round(100 * share)} %`;
      });
      const { session } = await this.desk.request('replay.open', { recording });
      this.actions.go(session);
    } catch (error) {
      if (!(error instanceof RequestError)) throw error;
      this.desk.refuse(error);
    } finally {
      this.progress.textContent = '';
    }
  }
}
