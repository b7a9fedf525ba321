import type { Camera, Material, Mesh, Object3D, Scene, WebGLRenderer } from 'three';
import type { WebGLRenderTarget } from 'three';

interface Program {
  isReady(): boolean;
  /** Waits for all previous commands of the graphics, for the first time. */
  getUniforms(): unknown;
}

/**
 * Compiles the shaders of new meshes. The browser compiles in the background, and a picture before
 * the end would block the page.
 */
export class WarmUp {
  private readonly known = new WeakSet<Material>();
  private readonly pending = new Set<Material>();
  private readonly programs = new WeakSet<Program>();
  /** Passed when the graphics has executed all compilations. */
  private fence: WebGLSync | null = null;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly scene: Scene,
  ) {}

  /**
   * Starts the compilation for visible meshes. `targetOf` returns the target that a mesh is drawn to;
   * null: the canvas. Returns whether all shaders are ready.
   */
  advance(camera: Camera, targetOf: (mesh: Object3D) => WebGLRenderTarget | null): boolean {
    const { renderer, scene, known, pending } = this;
    const gl = renderer.getContext() as WebGL2RenderingContext;
    const before = pending.size;
    scene.traverseVisible((object) => {
      const { material, isMesh } = object as Mesh;
      if (!isMesh || Array.isArray(material) || known.has(material)) return;
      known.add(material);
      pending.add(material);
      renderer.setRenderTarget(targetOf(object));
      renderer.compile(object, camera, scene);
    });
    renderer.setRenderTarget(null);
    if (gl.isContextLost()) {
      this.fence = null;
      return true;
    }
    if (pending.size > before) {
      gl.deleteSync(this.fence);
      this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
    }
    // Without KHR_parallel_shader_compile, every program is always "ready".
    if (this.fence) {
      if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
      gl.deleteSync(this.fence);
      this.fence = null;
    }
    for (const material of pending) {
      const { currentProgram } = renderer.properties.get(material) as { currentProgram?: Program };
      if (currentProgram?.isReady() === false) continue;
      pending.delete(material);
      if (!currentProgram || this.programs.has(currentProgram)) continue;
      this.programs.add(currentProgram);
      currentProgram.getUniforms();
      break; // one program per animation frame, so that the page answers
    }
    return pending.size === 0;
  }
}
