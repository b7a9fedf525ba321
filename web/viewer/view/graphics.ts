import type { WebGLRenderer } from 'three';

/** What the browser draws with. */
export interface Graphics {
  /** The processor does the drawing. */
  isSoftware: boolean;
  /** Pictures of exact numbers, which a clear liquid needs, can be drawn. */
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
