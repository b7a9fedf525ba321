/** Pictures beyond this number would only add delay. */
const kMost = 2;

/** The pictures that the graphics has begun and not finished. */
export class UnfinishedPictures {
  private readonly fences: WebGLSync[] = [];

  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Whether another picture must wait. Call it once per animation frame at most. */
  areMost(): boolean {
    const { gl, fences } = this;
    // A lost context signals nothing, and the fences of a lost context have no status.
    if (gl.isContextLost()) fences.length = 0;
    while (fences[0] && gl.getSyncParameter(fences[0], gl.SYNC_STATUS) !== gl.UNSIGNALED) {
      gl.deleteSync(fences.shift()!);
    }
    return fences.length >= kMost;
  }

  /** Adds the picture that consists of all previous commands. */
  add(): void {
    const fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (fence) this.fences.push(fence);
    this.gl.flush();
  }
}
