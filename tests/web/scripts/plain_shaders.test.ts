import { expect, it } from 'vitest';
import { withPlainShaders } from '../../../web/scripts/plain_shaders';

it('removes comments and indentation of shaders, and nothing else', () => {
  const source = [
    '// kept',
    'const kShader = /* glsl */ `',
    '  ${kOther}',
    '  /**',
    '   * About \\`light\\`.',
    '   */',
    '  vec3 light(vec3 n) {',
    '    // the sun',
    '    return 2.0 * n; // twice',
    '  }',
    '',
    '  #if FINISH == ${number}',
    '  #endif',
    '`;',
    'const kText = `  // kept too`;',
  ].join('\n');
  expect(withPlainShaders(source).split('\n')).toEqual([
    '// kept',
    'const kShader = /* glsl */ `',
    '${kOther}',
    'vec3 light(vec3 n) {',
    'return 2.0 * n;',
    '}',
    '#if FINISH == ${number}',
    '#endif',
    '`;',
    'const kText = `  // kept too`;',
  ]);
});
