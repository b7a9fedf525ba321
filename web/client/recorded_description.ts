import type { BodyDescription, SessionDescription, VatDescription } from './messages.js';
import { lengthOf, materialOf, shapeOf } from './recorded_look.js';
import { bad, choiceOf, countOf, listOf, numberOf, numbersOf } from './recording/values.js';
import { objectOf, textOf, vectorOf } from './recording/values.js';

/** A description of a recording, for the frames from `firstFrame` to the next description. */
export interface RecordedScene {
  firstFrame: number;
  description: SessionDescription;
}

const kMostBodies = 4096;
const kMostMaterials = 4096;
const kMostParticles = 1_000_000;
const kLevels = ['coarse', 'normal', 'fine', 'finest'] as const;

/**
 * Reads a description. Its values come from a file, so that each one is checked. Omits unknown
 * members.
 * @throws RecordingError
 */
export function readDescription(bytes: ArrayBuffer, firstFrame: number): RecordedScene {
  let value: unknown;
  try {
    value = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch {
    throw bad('the description', 'JSON');
  }
  const members = objectOf(value, 'the description');
  const scene = textOf(members.scene, 'scene');
  const title = textOf(members.title, 'title');
  const description: SessionDescription = {
    session: '',
    name: title === '' ? scene : title,
    scene,
    ...(members.level !== undefined && { level: choiceOf(members.level, 'level', kLevels) }),
    title,
    epoch: countOf(members.epoch, 'epoch'),
    tick: 0,
    playing: true,
    speed: 1,
    tick_seconds: numberOf(members.tick_seconds, 'tick_seconds', 1e-9, 1e9),
    gravity: vectorOf(members.gravity, 'gravity'),
    vat: members.vat === null ? null : vatOf(members.vat),
    materials: listOf(members.materials, 'materials', kMostMaterials).map(materialOf),
    bodies: listOf(members.bodies, 'bodies', kMostBodies).map(bodyOf),
  };
  return { firstFrame, description };
}

function bodyOf(value: unknown): BodyDescription {
  const members = objectOf(value, 'a body');
  const body: BodyDescription = {
    body: countOf(members.body, 'body'),
    name: textOf(members.name, 'name'),
    kind: choiceOf(members.kind, 'kind', ['liquid', 'deformable', 'rigid'] as const),
    material: textOf(members.material, 'material'),
    particles: countOf(members.particles, 'particles'),
    radius: numberOf(members.radius, 'radius', 0, 1e9),
  };
  const { shape, spacing, rest_positions: rest, local_positions: local } = members;
  if (shape !== undefined) body.shape = shapeOf(shape);
  if (spacing !== undefined) body.spacing = lengthOf(spacing, 'spacing');
  if (rest !== undefined) body.rest_positions = triplesOf(rest, 'rest_positions');
  if (body.kind !== 'rigid') return body;
  body.local_positions = triplesOf(local, 'local_positions');
  if (body.local_positions.length === 3 * body.particles) return body;
  throw bad('local_positions', 'three numbers for each particle');
}

function triplesOf(value: unknown, name: string): number[] {
  const numbers = numbersOf(value, name, 3 * kMostParticles);
  if (numbers.length % 3 === 0) return numbers;
  throw bad(name, 'three numbers for each particle');
}

function vatOf(value: unknown): VatDescription {
  const { min, max, lid } = objectOf(value, 'vat');
  if (typeof lid !== 'boolean') throw bad('lid', 'true or false');
  return { min: vectorOf(min, 'min'), max: vectorOf(max, 'max'), lid };
}
