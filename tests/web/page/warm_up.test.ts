import { BoxGeometry, Camera, Mesh, MeshBasicMaterial, Scene } from 'three';
import type { WebGLRenderer } from 'three';
import { expect, test } from 'vitest';
import { WarmUp } from '../../../web/viewer/view/warm_up';

/** Graphics that compile in the background until `isDone`, without saying so in isReady(). */
function graphics() {
  const state = { isDone: false, asked: 0, compiled: 0 };
  const gl = {
    SYNC_GPU_COMMANDS_COMPLETE: 1,
    SYNC_STATUS: 2,
    SIGNALED: 3,
    fenceSync: () => ({}),
    deleteSync: () => undefined,
    flush: () => undefined,
    isContextLost: () => false,
    getSyncParameter: () => (state.isDone ? 3 : 0),
  };
  const programs = new Map<unknown, object>();
  const renderer = {
    setRenderTarget: () => undefined,
    getContext: () => gl,
    compile: (mesh: Mesh) => {
      ++state.compiled;
      programs.set(mesh.material, { isReady: () => true, getUniforms: () => ++state.asked });
    },
    properties: { get: (material: unknown) => ({ currentProgram: programs.get(material) }) },
  };
  return { state, renderer: renderer as unknown as WebGLRenderer };
}

test('the page never waits for a compilation, and asks for one program per animation frame', () => {
  const { state, renderer } = graphics();
  const scene = new Scene();
  scene.add(new Mesh(new BoxGeometry(), new MeshBasicMaterial()));
  scene.add(new Mesh(new BoxGeometry(), new MeshBasicMaterial()));
  const warmUp = new WarmUp(renderer, scene);
  const advance = () => warmUp.advance(new Camera(), () => null);
  expect(advance()).toBe(false);
  expect(advance()).toBe(false);
  expect(state).toEqual({ isDone: false, asked: 0, compiled: 2 });
  state.isDone = true;
  expect(advance()).toBe(false);
  expect(state.asked).toBe(1);
  expect(advance()).toBe(true);
  expect(state).toEqual({ isDone: true, asked: 2, compiled: 2 });

  // A mesh that is added after the start.
  state.isDone = false;
  scene.add(new Mesh(new BoxGeometry(), new MeshBasicMaterial()));
  expect(advance()).toBe(false);
  state.isDone = true;
  expect(advance()).toBe(true);
  expect(state).toEqual({ isDone: true, asked: 3, compiled: 3 });
});
