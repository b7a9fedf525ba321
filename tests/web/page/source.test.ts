import { describe, expect, it } from 'vitest';
import { sourceOf } from '../../../web/element/source';

const kPage = 'https://site.example/articles/water.html';

describe('the source of <vat-viewer>', () => {
  it.each([
    ['ws://host:8080/ws', { url: 'ws://host:8080/ws', session: undefined, token: undefined }],
    ['wss://host/ws?session=s2', { url: 'wss://host/ws', session: 's2', token: undefined }],
    ['wss://host/ws?session=s2#invite=abc', { url: 'wss://host/ws', session: 's2', token: 'abc' }],
  ])('%s is a session', (src, place) => {
    expect(sourceOf(src, kPage)).toMatchObject({ place, recording: undefined });
  });

  it.each([
    ['wave.vatrec', 'https://site.example/articles/wave.vatrec'],
    ['/wave.vatrec', 'https://site.example/wave.vatrec'],
    ['https://files.example/wave.vatrec', 'https://files.example/wave.vatrec'],
  ])('%s is a recording', (src, address) => {
    const { place, recording } = sourceOf(src, kPage);
    expect(recording).toBe(address);
    expect(place.base).toBe(address); // so that the author can choose any origin
  });

  it.each([
    ['http://', 'is not an address'],
    ['ftp://host/wave.vatrec', 'must begin with'],
    ['javascript:alert(1)', 'must begin with'],
  ])('%s is invalid', (src, words) => {
    expect(() => sourceOf(src, kPage)).toThrow(words);
  });
});
