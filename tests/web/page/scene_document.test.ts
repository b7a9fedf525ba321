import { expect, it } from 'vitest';
import type { Scene } from '../../../web/client/index';
import { SceneDocument } from '../../../web/viewer/build/scene_document';
import type { Request } from '../../../web/viewer/stream/stream';

/** A document whose test answers the requests, in any order. */
function asked(): { document: SceneDocument; answers: ((name?: string) => void)[] } {
  const answers: ((name?: string) => void)[] = [];
  const request = (): Promise<{ scene: Scene }> =>
    new Promise((resolve, reject) => {
      answers.push((name) =>
        name === undefined
          ? reject(new Error('too long'))
          : resolve({ scene: { format: 'vat.scene/1', name, materials: [], bodies: [] } }),
      );
    });
  return { document: new SceneDocument(request as unknown as Request), answers };
}

it('requests each scene once until it is discarded', async () => {
  const { document, answers } = asked();
  const both = [document.get(), document.asLoaded(), document.get(), document.asLoaded()];
  expect(answers).toHaveLength(2);
  answers[0]!('now');
  answers[1]!('before');
  const names = (await Promise.all(both)).map((scene) => scene?.name);
  expect(names).toEqual(['now', 'before', 'now', 'before']);
  document.forget();
  void document.get();
  void document.asLoaded();
  expect(answers).toHaveLength(3);
});

it('does not keep a scene that was requested before a later one was loaded', async () => {
  const { document, answers } = asked();
  const old = document.asLoaded();
  document.restart();
  const young = document.asLoaded();
  answers[0]!('old');
  expect((await old)?.name).toBe('old');
  answers[1]!('young');
  expect((await young)?.name).toBe('young');
  expect((await document.asLoaded())?.name).toBe('young');
});

it('uses the present scene if the loaded one exceeds a message', async () => {
  const { document, answers } = asked();
  const loaded = document.asLoaded();
  answers[0]!();
  await Promise.resolve(); // the rejection asks again
  await Promise.resolve();
  answers[1]!('now');
  expect((await loaded)?.name).toBe('now');
});
