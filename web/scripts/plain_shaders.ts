import type { Plugin } from 'vite';

/** Shaders in TypeScript: template literals with this mark. */
const kShader = /(\/\* glsl \*\/ `)((?:[^`\\]|\\.)*)`/gs;
const kComment = /\/\*.*?\*\/|\/\/[^\n]*/gs;

/** Returns a source without the comments and the indentation of its shaders. */
export function withPlainShaders(source: string): string {
  return source.replace(kShader, (_, mark: string, shader: string) => {
    const plain = shader.replace(kComment, '').replace(/\s*\n\s*/g, '\n');
    return `${mark}${plain}\``;
  });
}

/** Shortens the shaders of a build. The page loads them before its first picture. */
export function plainShaders(): Plugin {
  return {
    name: 'plain-shaders',
    apply: 'build',
    enforce: 'pre',
    transform: (source, id) =>
      id.endsWith('.ts') && source.includes('/* glsl */') ? withPlainShaders(source) : undefined,
  };
}
