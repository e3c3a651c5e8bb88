// What both viewers' pages hand back: the floats of a picture as text, and how far the picture on the canvas is off.

export function asText(floats) {
  const bytes = new Uint8Array(floats.buffer);
  let text = '';
  for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
  return btoa(text);
}

const srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

// Median over all channels of the steps of 8 bits between the canvas and the floats (rows from the bottom up) in sRGB,
// cut at 1: no tone curve, no exposure.
export async function canvasError(png, floats, width, height) {
  const image = Object.assign(new Image(), { src: png });
  await image.decode();
  const flat = Object.assign(document.createElement('canvas'), { width, height }).getContext('2d');
  flat.drawImage(image, 0, 0);
  const shown = flat.getImageData(0, 0, width, height).data, steps = [];
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      for (let c = 0; c < 3; ++c) {
        const value = floats[4 * ((height - 1 - y) * width + x) + c];
        steps.push(Math.abs(shown[4 * (y * width + x) + c] - 255 * srgb(Math.min(Math.max(value, 0), 1))));
      }
  return steps.sort((a, b) => a - b)[steps.length >> 1];
}
