import { appendFileSync, mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import WebSocket from 'ws';
import type { Page } from 'playwright-core';

// Records the messages of pages and observers in the folder VAT_TRANSCRIPT. A later test checks
// them against the schemas.

const folder = process.env.VAT_TRANSCRIPT;
const file = join(folder ?? '', `browser-${process.pid}.jsonl`);
let connections = 0;

if (folder) {
  mkdirSync(folder, { recursive: true });
  rmSync(file, { force: true });
}

/** The transcript of one connection. Binary messages are frames and are not recorded. */
class Record {
  private readonly connection = `${++connections}`;

  note(direction: 'sent' | 'received', message: unknown): void {
    if (!folder || typeof message !== 'string') return;
    const line = { connection: this.connection, [direction]: message };
    appendFileSync(file, `${JSON.stringify(line)}\n`);
  }
}

export function recordPage(page: Page): void {
  page.on('websocket', (socket) => {
    const record = new Record();
    socket.on('framesent', ({ payload }) => record.note('sent', payload));
    socket.on('framereceived', ({ payload }) => record.note('received', payload));
  });
}

/** A Node socket that records its messages. */
export class RecordedSocket extends WebSocket {
  private readonly record = new Record();

  constructor(url: string, protocol: string) {
    super(url, protocol);
    this.on('message', (data: Buffer, isBinary: boolean) => {
      if (!isBinary) this.record.note('received', data.toString());
    });
  }

  override send(text: string): void {
    this.record.note('sent', text);
    super.send(text);
  }
}
