import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { element, onPress } from '../panel/elements';
import { poseToText } from '../view/base/pose';
import type { Pose } from '../view/base/pose';
import type { People } from '../stream/people';

/** The subject of a link: a session, or a recording by its address. */
export type Subject = { session: string } | { recording: string };

/** Optional parts of a link. */
export interface Outlook {
  readonly pose: Pose;
  /** Settings of the view; empty if all have defaults. */
  readonly view: string;
  /** The position of a replay or a recording; undefined for live sessions. */
  readonly moment: number | undefined;
  /** The address of the shown recording; undefined for sessions and for local files. */
  readonly recording: string | undefined;
}

/** Returns parts of links that change while the page is shown. */
export function linkParts(
  moment: () => number | undefined,
  recording: () => string | undefined,
): Pick<Outlook, 'moment' | 'recording'> {
  return {
    get moment() {
      return moment();
    },
    get recording() {
      return recording();
    },
  };
}

/** Returns the address for other users. */
export function shareLink(
  page: string,
  subject: Subject,
  { invite, pose, view, moment }: { invite?: string } & Partial<Omit<Outlook, 'recording'>>,
): string {
  const url = new URL(page);
  url.search = new URLSearchParams(subject).toString();
  const parts = new URLSearchParams();
  if (invite) parts.set('invite', invite);
  if (moment !== undefined) parts.set('at', String(moment));
  if (pose) parts.set('camera', poseToText(pose));
  if (view) parts.set('view', view);
  url.hash = parts.toString();
  return url.href;
}

/** Returns whether other machines cannot reach the server at this address. */
export function isOfThisComputer(host: string): boolean {
  return host === 'localhost' || host === '[::1]' || host.startsWith('127.');
}

/** The dialog that creates a link to this session. */
export class Share {
  private readonly dialog = element('share', HTMLDialogElement);
  private readonly opener = element('share-open', HTMLButtonElement);
  private readonly text = element('share-text', HTMLElement);
  private readonly note = element('share-local', HTMLElement);
  private readonly roleRow = element('share-role-row', HTMLElement);
  private readonly role = element('share-role', HTMLSelectElement);
  private readonly camera = element('share-camera', HTMLInputElement);
  private readonly view = element('share-view', HTMLInputElement);
  private readonly momentRow = element('share-moment-row', HTMLElement);
  private readonly moment = element('share-moment', HTMLInputElement);
  private readonly link = element('share-link', HTMLInputElement);
  private readonly copied = element('share-copied', HTMLElement);
  private invite: string | undefined;

  constructor(
    private readonly people: People,
    private readonly outlook: Outlook,
    private readonly desk: Desk,
  ) {
    onPress(this.opener, () => this.open());
    onPress(element('share-copy', HTMLButtonElement), () => void this.copy());
    for (const box of [this.camera, this.view, this.moment])
      box.addEventListener('change', () => this.write());
    this.role.addEventListener('change', () => void this.inviteAnew());
  }

  open(): void {
    if (this.opener.disabled) return;
    this.invite = undefined;
    const mayInvite = this.people.isOwner && this.outlook.recording === undefined;
    this.roleRow.hidden = !mayInvite;
    this.momentRow.hidden = this.outlook.moment === undefined;
    this.text.textContent = this.inWords();
    this.note.hidden = !isOfThisComputer(location.hostname);
    this.write();
    this.dialog.showModal();
    if (mayInvite) void this.inviteAnew();
  }

  enable(enabled: boolean): void {
    this.opener.disabled = !enabled;
  }

  get isEnabled(): boolean {
    return !this.opener.disabled;
  }

  private inWords(): string {
    if (this.outlook.recording !== undefined) return 'This link opens the same recording.';
    const { isOwner, settings } = this.people;
    const mayChange = !isOwner && settings?.default_role === 'controller';
    return `This link opens the same session${mayChange ? ', with permission to change it' : ''}.`;
  }

  /** Creates an invitation for owners. The links of others grant the session's default role. */
  private async inviteAnew(): Promise<void> {
    const role = this.role.value as 'viewer' | 'controller';
    const answer = await ask(this.desk, 'session.invite', { role });
    if (!answer) return;
    this.invite = answer.token;
    this.write();
  }

  private write(): void {
    const { pose, view, moment, recording } = this.outlook;
    const subject = recording === undefined ? { session: this.people.session } : { recording };
    this.copied.textContent = '';
    this.link.value = shareLink(location.href, subject, {
      ...(this.invite !== undefined && { invite: this.invite }),
      ...(this.camera.checked && { pose }),
      ...(this.view.checked && { view }),
      ...(this.moment.checked && { moment }),
    });
  }

  private async copy(): Promise<void> {
    this.link.select();
    try {
      await navigator.clipboard.writeText(this.link.value);
      this.copied.textContent = 'Copied.';
    } catch {
      // Browsers restrict this function to secure pages.
      this.copied.textContent = 'The browser does not allow the page to copy. Press Ctrl+C.';
    }
  }
}
