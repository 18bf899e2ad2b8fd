import {encode} from 'uqr';

/** The dark squares of a QR code as one path in a square of `size` units, with the border of four units that readers need. */
export interface QrCode { size: number; path: string }

export function qrCode(text: string): QrCode {
  const {size, data} = encode(text, {ecc: 'M', border: 4});
  const squares = data.flatMap((row, y) => row.flatMap((isDark, x) => (isDark ? [`M${x} ${y}h1v1h-1z`] : [])));
  return {size, path: squares.join('')};
}
