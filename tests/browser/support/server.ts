import { spawn } from 'node:child_process';
import type { ChildProcess } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';

const kStartMs = 60_000;

/** Returns the path of the built program. */
export function program(): string {
  const path = process.env.VAT_PROGRAM;
  if (!path) throw new Error('VAT_PROGRAM must be the path of the built program `vat`');
  return path;
}

/** Returns the environment without the tests' variables, which are not server settings. */
function foreignEnvironment(): NodeJS.ProcessEnv {
  const all = Object.entries(process.env);
  return Object.fromEntries(all.filter(([name]) => !name.startsWith('VAT_')));
}

/** The admin token of every server of the tests. */
export const kAdminToken = 'the admin token of the browser tests';

/** A server of the pages of a test file. */
export interface Host {
  readonly url: string;
  start(): Promise<void>;
  kill(): Promise<void>;
}

/** The real server, as a user starts it. */
export class Server implements Host {
  private process: ChildProcess | undefined;
  private port = 0;

  /** Uses these flags of `vat serve`. */
  constructor(private readonly flags: readonly string[] = []) {}

  get url(): string {
    return `http://127.0.0.1:${this.port}/`;
  }

  /** Resolves after it listens: on any free port at first, later on the same port. */
  async start(): Promise<void> {
    const child = spawn(program(), ['serve', '--port', String(this.port), ...this.flags], {
      stdio: ['ignore', 'pipe', 'inherit'],
      env: { ...foreignEnvironment(), VAT_ADMIN_TOKEN: kAdminToken, VAT_LOG_LEVEL: 'warn' },
    });
    this.process = child;
    this.port = await announcedPort(child);
  }

  /** Resolves after it has ended by itself. */
  async ended(): Promise<void> {
    const child = this.process;
    if (child && child.exitCode === null && child.signalCode === null) await once(child, 'exit');
  }

  /** Kills it without notice, as a crash. */
  async kill(): Promise<void> {
    const child = this.process;
    if (!child || child.exitCode !== null || child.signalCode !== null) return;
    const exited = once(child, 'exit');
    child.kill('SIGKILL');
    await exited;
  }
}

async function announcedPort(child: ChildProcess): Promise<number> {
  if (!child.stdout) throw new Error('the output of the server is not piped');
  const lines = createInterface({ input: child.stdout });
  const timer = setTimeout(() => child.kill('SIGKILL'), kStartMs);
  try {
    for await (const line of lines) {
      const port = /http:\/\/127\.0\.0\.1:(\d+)\//.exec(line)?.[1];
      if (port) return Number(port);
    }
  } finally {
    clearTimeout(timer);
    child.stdout.resume(); // discards later output
  }
  throw new Error('the server ended without saying where it is');
}
