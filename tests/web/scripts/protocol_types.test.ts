import { readFileSync } from 'node:fs';
import { expect, expectTypeOf, test } from 'vitest';
import type { ErrorData, Params, ReplyError, Result } from '../../../web/client/index';
import { generate } from '../../../web/scripts/protocol_types';

test('the types are those of the schemas: npm --prefix web run types writes them', async () => {
  const files = await generate();
  expect(files.map(({ path }) => path.replace(/.*\//, ''))).toEqual([
    'protocol.ts',
    'scene_format.ts',
  ]);
  for (const { path, text } of files) expect(text).toBe(readFileSync(path, 'utf8'));
});

test('methods and errors have the types that the schemas give', () => {
  expectTypeOf<Params<'control.step'>>().toEqualTypeOf<{ ticks?: number }>();
  expectTypeOf<Params<'grab.move'>['target']>().toEqualTypeOf<[number, number, number]>();
  expectTypeOf<Result<'session.hash'>['instruction_set']>().toEqualTypeOf<
    'baseline' | 'avx2' | 'avx512'
  >();
  expectTypeOf<ReplyError['data']>().toExtend<ErrorData>();
});
