export type FrameErrorCode =
  | 'bad_magic'
  | 'bad_version'
  | 'bad_type'
  | 'bad_header'
  | 'bad_block'
  | 'bad_check'
  | 'missing_reference'
  | 'truncated'
  | 'extra_bytes';

/** The reason why a frame is invalid. */
export class FrameError extends Error {
  constructor(
    readonly code: FrameErrorCode,
    message: string,
  ) {
    super(message);
    this.name = 'FrameError';
  }
}

export function badBlock(reason: string): never {
  throw new FrameError('bad_block', `a block is wrong: ${reason}`);
}
