import type { FrameHeader } from '../../../client/index';
import { formatLength } from '../format';

const kParts = [
  'an eighth of the particles',
  'a quarter of the particles',
  'half of the particles',
];

const kSigns = ['⅛', '¼', '½'];

/** Returns the share of received frames as text. */
export function rateInWords(stride: number): string {
  return stride === 1 ? 'every frame' : `every ${ordinal(stride)} frame`;
}

/** Returns the reductions for a slow viewer as text. */
export function lossInWords({
  stride,
  detail,
}: Pick<FrameHeader, 'stride' | 'detail'>): string | undefined {
  if (stride === 1 && kSigns[detail] === undefined) return undefined;
  const parts = stride === 1 ? [] : [`1 frame in ${stride}`];
  const part = kSigns[detail];
  if (part !== undefined) parts.push(`${part} of the particles`);
  return parts.join(', ');
}

/** Returns the rate, accuracy and level of detail of frames as text. */
export function qualityInWords({
  stride,
  quantum,
  detail,
  region,
}: Pick<FrameHeader, 'stride' | 'quantum' | 'detail' | 'region'>): string {
  const parts = [rateInWords(stride), `to ${formatLength(quantum / 2)}`];
  const part = kParts[detail];
  if (part) parts.push(part);
  if (region) parts.push('of a region');
  return parts.join(', ');
}

function ordinal(count: number): string {
  const isTeen = Math.floor(count / 10) % 10 === 1;
  const ending = isTeen ? undefined : ['th', 'st', 'nd', 'rd'][count % 10];
  return `${count}${ending ?? 'th'}`;
}
