import type { WebGLRenderer } from 'three';

/** The properties of the browser's graphics. */
export interface Graphics {
  /** Whether the CPU draws. */
  isSoftware: boolean;
  /** Whether floating-point textures can be drawn, which the fluid style requires. */
  drawsToFloats: boolean;
}

const kSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i;

export function graphicsOf(renderer: WebGLRenderer): Graphics {
  const context = renderer.getContext();
  const info = context.getExtension('WEBGL_debug_renderer_info');
  const name: unknown = context.getParameter(
    info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER,
  );
  return {
    isSoftware: kSoftware.test(String(name)),
    drawsToFloats: renderer.extensions.has('EXT_color_buffer_float'),
  };
}
