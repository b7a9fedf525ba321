/** Generates web/client/protocol.ts and scene_format.ts from the schemas in protocol/schemas/. */
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { compile } from 'json-schema-to-typescript';
import type { JSONSchema } from 'json-schema-to-typescript';

type Node = Record<string, unknown>;
interface SchemaFile {
  title: string;
  $defs: Record<string, Node>;
}

const kFolder = new URL('../../protocol/schemas/', import.meta.url);
const kShared = new Set(['common', 'errors', 'events', 'message', 'scene_format']);
const kBanner = '// Written from protocol/schemas/ by `npm run types`; not to be edited.';
/** Types of scenes and their parts in messages. */
const kSceneTypes: Readonly<Record<string, string>> = {
  appearance: 'Appearance',
  body: 'SceneBody',
  interface: 'SceneInterface',
  scene: 'Scene',
  shape: 'Shape',
};

export interface GeneratedFile {
  path: string;
  text: string;
}

function readSchemas(): Map<string, SchemaFile> {
  const names = readdirSync(kFolder).filter((name) => name.endsWith('.json'));
  return new Map(
    names
      .sort()
      .map((name) => [
        name.replace('.json', ''),
        JSON.parse(readFileSync(new URL(name, kFolder), 'utf8')) as SchemaFile,
      ]),
  );
}

/** Adapts a schema for one document of definitions. Omits bounds of lists that are not tuples. */
function adapt(node: unknown, file: string, scenes: string): unknown {
  if (Array.isArray(node)) return node.map((child) => adapt(child, file, scenes));
  if (typeof node !== 'object' || node === null) return node;
  const source = node as Node;
  if (typeof source.$ref === 'string') {
    const [from = '', definition = ''] = source.$ref.split('#/$defs/');
    const home = from === '' ? file : from.replace('.json', '');
    if (home === 'scene_format' && file !== 'scene_format') {
      return { tsType: kSceneTypes[definition] ?? scenes };
    }
    return { $ref: `#/definitions/${definition}` };
  }
  const isTuple = source.minItems === source.maxItems;
  const entries = Object.entries(source).filter(
    ([key]) => isTuple || (key !== 'minItems' && key !== 'maxItems'),
  );
  return Object.fromEntries(entries.map(([key, child]) => [key, adapt(child, file, scenes)]));
}

function definitionsOf(files: Map<string, SchemaFile>, names: string[]): Node {
  return Object.fromEntries(
    names.flatMap((name) =>
      Object.entries(files.get(name)?.$defs ?? {}).map(([key, definition]) => [
        key,
        key === 'nothing'
          ? { description: definition.description, tsType: 'Record<string, never>' }
          : adapt(definition, name, 'unknown'),
      ]),
    ),
  );
}

/** Returns the name of "control.step.params" in json-schema-to-typescript. */
function typeName(definition: string): string {
  return definition.replace(/(^|[._])([a-z])/g, (_, __, letter: string) => letter.toUpperCase());
}

/** Removes the origins of types, and bounds that the types contain. */
function tidyRemarks(text: string): string {
  return text.replace(/\/\*\*([\s\S]*?)\*\//g, (_, remark: string) => {
    const words = remark
      .split('\n')
      .map((line) => line.replace(/^\s*\*? ?/, '').trim())
      .filter(
        (line) => line !== '' && !/^(This interface was|via the `|@(min|max)Items )/.test(line),
      );
    return words.length === 0 ? '' : `/** ${words.join(' ')} */`;
  });
}

async function writeTypes(definitions: Node, head: string, tail: string): Promise<string> {
  const text = await compile({ definitions } as JSONSchema, 'Everything', {
    additionalProperties: false,
    bannerComment: `${kBanner}\n${head}`,
    unreachableDefinitions: true,
    style: { singleQuote: true, printWidth: 100 },
  });
  // The document of all definitions has no values, so it needs no type.
  return tidyRemarks(text.replace(/export interface Everything \{[^}]*\}\n/, '')) + tail;
}

/** Returns the type of a definition. For a reference, it is the type of its target. */
function typeOf(files: Map<string, SchemaFile>, file: string, definition: string): string {
  const reference = files.get(file)?.$defs[definition]?.$ref;
  if (typeof reference !== 'string') return typeName(definition);
  const [from = '', target = ''] = reference.split('#/$defs/');
  return typeOf(files, from === '' ? file : from.replace('.json', ''), target);
}

function tables(files: Map<string, SchemaFile>): string {
  const methodRows = [...files]
    .filter(([file]) => !kShared.has(file))
    .flatMap(([file, { $defs }]) =>
      Object.keys($defs)
        .filter((key) => key.endsWith('.params'))
        .map((key) => key.replace('.params', ''))
        .map((name) => {
          const params = typeOf(files, file, `${name}.params`);
          const result = typeOf(files, file, `${name}.result`);
          return `  '${name}': { params: ${params}; result: ${result} };\n`;
        }),
    );
  const events = Object.keys(files.get('events')?.$defs ?? {});
  const eventRows = events.map((name) => `  '${name}': ${typeOf(files, 'events', name)};\n`);
  const eventNames = events.map((name) => `  '${name}',\n`);
  return `
/** Parameters and result of each method. */
export interface Methods {
${methodRows.join('')}}

/** Parameters of each event. */
export interface Events {
${eventRows.join('')}}

export const kEventNames = [
${eventNames.join('')}] as const;
`;
}

/** Returns the contents of the files. */
export async function generate(): Promise<GeneratedFile[]> {
  const files = readSchemas();
  const groups = [...files.keys()].filter((name) => name !== 'scene_format' && name !== 'message');
  const imported =
    "import type { Appearance, Body as SceneBody, Interface as SceneInterface, Scene, Shape } from './scene_format.js';\n";
  const texts: [string, string][] = [
    ['protocol.ts', await writeTypes(definitionsOf(files, groups), imported, tables(files))],
    ['scene_format.ts', await writeTypes(definitionsOf(files, ['scene_format']), '', '')],
  ];
  return texts.map(([name, text]) => ({
    path: fileURLToPath(new URL(`../client/${name}`, import.meta.url)),
    text,
  }));
}

if (process.argv[1]?.includes('vite-node')) {
  for (const { path, text } of await generate()) writeFileSync(path, text);
}
