import { readFileSync } from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { expect, it } from 'vitest';
import { getLanguageService, TextDocument } from 'vscode-json-languageservice';

/** A language server, as in editors, with a scene that refers to the schema. */

const kScenes = fileURLToPath(new URL('../../protocol/scenes/', import.meta.url));

const service = getLanguageService({
  schemaRequestService: (address) =>
    Promise.resolve(readFileSync(fileURLToPath(new URL(address)), 'utf8')),
  workspaceContext: {
    resolveRelativePath: (path, base) => new URL(path, base).href,
  },
});

const dambreak = readFileSync(`${kScenes}dam-break.json`, 'utf8');

/** Returns the dam break, with `to` in place of `from`, and the place of `mark` in it. */
function changed(from: string, to: string, mark = '') {
  expect(dambreak).toContain(from);
  const text = dambreak.replace(from, to);
  const document = TextDocument.create(
    pathToFileURL(`${kScenes}dam-break.json`).href,
    'json',
    1,
    text,
  );
  return {
    document,
    json: service.parseJSONDocument(document),
    place: document.positionAt(text.indexOf(mark) + 1),
  };
}

it.each([
  ['a correct scene', '"tick": ', '"tick": ', []],
  ['a value beyond its range', '"tick": ', '"tick": 7', ['Value is above the maximum of 1.']],
  [
    'an unknown member',
    '"numerics": {',
    '"numerics": {"stepp": 1, ',
    ['Property stepp is not allowed.'],
  ],
  [
    'an unknown solver',
    '"materials"',
    '"pressure_solver": "x", "materials"',
    ['Value is not accepted. Valid values: "gas", "tait", "incompressible".'],
  ],
] as const)('has the faults of %s', async (_, from, to, expected) => {
  const { document, json } = changed(from, to);
  const faults = await service.doValidation(document, json);
  expect(faults.map(({ message }) => message)).toEqual(expected);
});

it('describes a member with its unit', async () => {
  const { document, json, place } = changed('"viscosity"', '"viscosity"', '"viscosity"');
  const hover = await service.doHover(document, place, json);
  expect(JSON.stringify(hover?.contents)).toMatch(/Dynamic viscosity .*Pa s/);
});

it('completes members and values', async () => {
  const members = changed('"numerics": {', '"numerics": {"c', '{"c');
  const { document, json, place } = members;
  const list = await service.doComplete(
    document,
    { ...place, character: place.character + 1 },
    json,
  );
  const control = list?.items.find(({ label }) => label === 'control');
  expect(JSON.stringify(control?.documentation)).toContain('adaptive');
  const value = changed('"materials"', '"kernel": "", "materials"', '""');
  const values = await service.doComplete(value.document, value.place, value.json);
  expect(values?.items.map(({ label }) => label)).toEqual(
    expect.arrayContaining(['"wendland_c2"', '"cubic_spline"']),
  );
});
