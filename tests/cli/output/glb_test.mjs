// Checks the .glb files of `vat simulate` with the validator of the Khronos Group, and compares their
// poses and points with those of the .csv files.
// Usage: node glb_test.mjs VAT FOLDER_OF_SCENES CATALOGUE
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';

const validator = createRequire(new URL('../../../web/package.json', import.meta.url))('gltf-validator');
const [vat, scenes, catalogue] = process.argv.slice(2);

const folder = mkdtempSync(join(tmpdir(), 'vat-glb-'));
process.on('exit', () => rmSync(folder, { recursive: true }));

function simulate(scene, output, ...options) {
  execFileSync(vat, ['simulate', scene, '--output', join(folder, output), ...options], { stdio: 'pipe' });
}

/** The file as JSON and as a function that returns the numbers of an accessor, element by element. */
function read(name) {
  const bytes = readFileSync(join(folder, name));
  const size = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.toString('utf8', 20, 20 + size));
  const buffer = 20 + size + 8;
  const accessor = (index) => {
    const { bufferView, componentType, count, type } = json.accessors[index];
    const components = { SCALAR: 1, VEC3: 3, VEC4: 4 }[type];
    const begin = buffer + json.bufferViews[bufferView].byteOffset;
    return Array.from({ length: count }, (_, i) =>
      Array.from({ length: components }, (_, c) => {
        const at = begin + 4 * (i * components + c);
        return componentType === 5126 ? bytes.readFloatLE(at) : bytes.readUInt32LE(at);
      }),
    );
  };
  const channels = (json.animations?.[0].channels ?? []).map(({ sampler, target }) => {
    const { input, output, interpolation } = json.animations[0].samplers[sampler];
    return { node: target.node, path: target.path, interpolation,
      times: accessor(input).flat(), values: accessor(output) };
  });
  return { bytes, json, accessor, channels };
}

async function expectValid(bytes, ...allowed) {
  const { issues, validatorVersion } = await validator.validateBytes(new Uint8Array(bytes));
  assert.ok(validatorVersion);
  const found = issues.messages.filter(({ code }) => !allowed.includes(code));
  assert.deepEqual(found, []);
}

/** The rows of a table by their time, in order. */
function rowsByTime(name) {
  const [header, ...lines] = readFileSync(join(folder, name), 'utf8').trim().split('\n');
  const columns = header.split(',').length;
  const times = new Map();
  for (const line of lines) {
    // The name of a body can contain a comma. The numbers follow it.
    const cells = line.split(',');
    const row = [cells[0], ...cells.slice(cells.length - columns + 2)];
    if (!times.has(row[0])) times.set(row[0], []);
    times.get(row[0]).push(row);
  }
  return [...times.values()];
}

const nodeNamed = (json, name) => json.nodes.findIndex((node) => node.name === name);
const closeTo = (found, expected, error) => {
  assert.equal(found.length, expected.length);
  found.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= error, `${value} ${expected[i]}`));
};

test('catalogue scenes give valid files', async () => {
  for (const scene of ['rigid-stack', 'pour', 'melting', 'paddle-wheel']) {
    simulate(`${catalogue}/${scene}.json`, `${scene}.glb`, '--until', '0.1');
    await expectValid(read(`${scene}.glb`).bytes, 'UNUSED_OBJECT'); // materials without particles
  }
});

test('rigid bodies have the poses of the diagnostics', async () => {
  const outputs = ['--until', '0.2', '--every', '0.04', '--diagnostics', join(folder, 'd.csv')];
  simulate(`${scenes}/mixed.json`, 'mixed.glb', ...outputs);
  const { bytes, json, channels } = read('mixed.glb');
  await expectValid(bytes);
  const ball = nodeNamed(json, 'ball, "red"');
  const of = (path) => channels.find((channel) => channel.node === ball && channel.path === path);
  const lines = readFileSync(join(folder, 'd.csv'), 'utf8').trim().split('\n');
  // A quoted name contains a comma, so that columns are counted from the end: w, then q, then t, f,
  // l, p and the centre of mass.
  const rows = lines.slice(1).map((line) => line.split(',').map(Number));
  assert.equal(of('translation').times.length, 6);
  rows.forEach((row, i) => {
    const end = row.length;
    closeTo([of('translation').times[i]], [row[0]], 1e-7);
    closeTo(of('translation').values[i], row.slice(end - 22, end - 19), 1e-6);
    const [w, x, y, z] = row.slice(end - 7, end - 3);
    const sign = Math.sign(w * of('rotation').values[i][3]);
    closeTo(of('rotation').values[i], [x, y, z, w].map((value) => sign * value), 1e-6);
  });
  assert.ok(Math.abs(of('rotation').values[5][1]) > 0.2); // it turns about y by 0.6
  const root = json.nodes[0];
  assert.ok(root.children.includes(ball));
  closeTo(root.rotation, [-Math.SQRT1_2, 0, 0, Math.SQRT1_2], 1e-12); // z becomes y
});

test('each key frame has the particles, and is shown from its time on', () => {
  simulate(`${scenes}/mixed.json`, 'keys.glb', '--until', '0.1', '--every', '0.05');
  simulate(`${scenes}/mixed.json`, 'keys.csv', '--until', '0.1', '--every', '0.05');
  const { json, accessor, channels } = read('keys.glb');
  const frames = rowsByTime('keys.csv');
  const keys = channels.filter((channel) => channel.path === 'scale');
  assert.equal(keys.length, frames.length);
  keys.forEach(({ node, interpolation, times, values }, k) => {
    const points = json.meshes[json.nodes[node].mesh].primitives.flatMap(({ attributes, mode }) => {
      assert.equal(mode, 0);
      return accessor(attributes.POSITION);
    });
    const text = (position) => position.map((value) => Math.fround(value)).join();
    const expected = frames[k].filter((row) => row[1] !== 'rigid');
    assert.deepEqual(points.map(text).sort(),
      expected.map((row) => text(row.slice(3, 6).map(Number))).sort());
    assert.equal(interpolation, 'STEP');
    const shown = times.map((time, i) => [Math.round(time / 0.05), values[i][0]]);
    const all = [[0, 0], [k, 1], [k + 1, 0]];
    assert.deepEqual(shown, all.slice(k === 0 ? 1 : 0, k + 1 < frames.length ? 3 : 2));
    assert.deepEqual(json.nodes[node].scale ?? [1, 1, 1], k === 0 ? [1, 1, 1] : [0, 0, 0]);
  });
});

test('long runs have at most 120 key frames, and all poses', async () => {
  simulate(`${scenes}/mixed.json`, 'long.glb', '--until', '0.122', '--every', '0.001');
  const { bytes, channels } = read('long.glb');
  await expectValid(bytes);
  assert.equal(channels.filter(({ path }) => path === 'scale').length, 62); // every second of 123
  assert.equal(channels.find(({ path }) => path === 'rotation').times.length, 123);
});

test('a vat that slides is animated', () => {
  simulate(`${catalogue}/sliding-vat-solids.json`, 'slide.glb', '--until', '0.5');
  const { json, channels } = read('slide.glb');
  const motion = channels.find(({ node, path }) => node === nodeNamed(json, 'vat') && path === 'translation');
  assert.ok(Math.max(...motion.values.at(-1).map(Math.abs)) > 0.001);
  assert.deepEqual(motion.values[0], [0, 0, 0]);
});

test('one output has no animation', async () => {
  simulate(`${scenes}/mixed.json`, 'one.glb', '--until', '0');
  const { bytes, json } = read('one.glb');
  await expectValid(bytes);
  assert.equal(json.animations, undefined);
});

test('surfaces replace the points of liquids', async () => {
  simulate(`${scenes}/mixed.json`, 'surface.glb', '--until', '0.04', '--every', '0.02', '--surface');
  const { bytes, json, accessor } = read('surface.glb');
  await expectValid(bytes);
  simulate(`${scenes}/mixed.json`, 'surface.csv', '--until', '0.04', '--every', '0.02');
  const frames = rowsByTime('surface.csv');
  const keys = json.nodes.filter(({ name }) => name?.startsWith('particles at'));
  assert.equal(keys.length, frames.length);
  keys.forEach(({ mesh }, k) => {
    const points = [];
    const corners = [];
    for (const { attributes, indices, mode } of json.meshes[mesh].primitives) {
      const positions = accessor(attributes.POSITION);
      if (mode === 0) points.push(...positions);
      else corners.push(...accessor(indices).map(([i]) => positions[i]));
    }
    const kind = (name) => frames[k].filter((row) => row[1] === name);
    assert.equal(points.length, kind('deformable').length);
    assert.ok(corners.length > 100);
    const highest = (list, z) => Math.max(...list.map((row) => row[z]));
    const beyond = highest(corners, 2) - highest(kind('liquid').map((row) => row.map(Number)), 5);
    assert.ok(beyond > 0 && beyond < 1.8 * 0.025, `${beyond}`); // radius 0.025 m
  });
});
