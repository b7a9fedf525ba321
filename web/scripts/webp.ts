/**
 * Runs in the browser: converts a picture to WebP in base64, with the best quality that is small
 * enough.
 */
export async function compress([address, most]: readonly [string, number]): Promise<string> {
  const image = new Image();
  image.src = address;
  await image.decode();
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.width, image.height];
  canvas.getContext('2d')!.drawImage(image, 0, 0);
  for (let quality = 0.9; quality > 0.3; quality -= 0.1) {
    const url = canvas.toDataURL('image/webp', quality);
    const base64 = url.slice(url.indexOf(',') + 1);
    if (base64.length * 0.75 <= most) return base64;
  }
  throw new Error('the picture is too rich');
}
