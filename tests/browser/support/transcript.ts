import { appendFileSync, mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import WebSocket from 'ws';
import type { Page } from 'playwright-core';

// What the pages and the observers say and hear is checked against the schemas, where
// VAT_TRANSCRIPT names a folder.

const folder = process.env.VAT_TRANSCRIPT;
const file = join(folder ?? '', `browser-${process.pid}.jsonl`);
let connections = 0;

if (folder) {
  mkdirSync(folder, { recursive: true });
  rmSync(file, { force: true });
}

/** Of one connection: binary messages are frames, and no part of it. */
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

/** A socket of Node that records. */
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
