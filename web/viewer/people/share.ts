import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { element, onPress } from '../panel/elements';
import { poseToText } from '../view/base/pose';
import type { Pose } from '../view/base/pose';
import type { People } from '../stream/people';

/** Optional parts of a link. */
export interface Outlook {
  readonly pose: Pose;
  /** Settings of the view; empty if all have defaults. */
  readonly view: string;
}

/** Returns the address for other users. */
export function shareLink(
  page: string,
  session: string,
  { invite, pose, view }: { invite?: string; pose?: Pose; view?: string },
): string {
  const url = new URL(page);
  url.search = new URLSearchParams({ session }).toString();
  const parts = new URLSearchParams();
  if (invite) parts.set('invite', invite);
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
    for (const box of [this.camera, this.view]) box.addEventListener('change', () => this.write());
    this.role.addEventListener('change', () => void this.inviteAnew());
  }

  open(): void {
    if (this.opener.disabled) return;
    this.invite = undefined;
    this.roleRow.hidden = !this.people.isOwner;
    this.text.textContent = this.inWords();
    this.note.hidden = !isOfThisComputer(location.hostname);
    this.write();
    this.dialog.showModal();
    if (this.people.isOwner) void this.inviteAnew();
  }

  enable(enabled: boolean): void {
    this.opener.disabled = !enabled;
  }

  private inWords(): string {
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
    const { pose, view } = this.outlook;
    this.copied.textContent = '';
    this.link.value = shareLink(location.href, this.people.session, {
      ...(this.invite !== undefined && { invite: this.invite }),
      ...(this.camera.checked && { pose }),
      ...(this.view.checked && { view }),
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
