import { describe, expect, it } from 'vitest';
import { download, linkedRecording } from '../../../web/viewer/stream/recording_file';

describe('the address of a recording', () => {
  it('is a parameter of the page', () => {
    expect(linkedRecording('http://a/?recording=b%20c.vatrec')).toBe('b c.vatrec');
    expect(linkedRecording('http://a/?session=s1')).toBeUndefined();
  });

  it.each([
    ['http://b/a.vatrec', 'same server'],
    ['//b/a.vatrec', 'same server'],
    ['javascript:alert(1)', 'same server'],
    ['http://', 'not valid'],
  ])('%s is refused', async (address, words) => {
    await expect(download(address, 'http://a/')).rejects.toThrow(words);
  });
});
