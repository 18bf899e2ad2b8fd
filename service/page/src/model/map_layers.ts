import type {UncertaintyMap} from '../api/documents.ts';

/** A layer of the map at one height (y): rows along z, cells along x; null where no posture brings the tip. */
export interface Layer { y_mm: number; rows: (number | null)[][] }

/** The map's cells are counted with x running fastest, then y, then z. */
export function layersOf({box, counts, cell_mm, values_mm}: UncertaintyMap): Layer[] {
  const [nx, ny, nz] = counts;
  const layers: Layer[] = [];
  for (let y = 0; y < ny; ++y) {
    const rows: (number | null)[][] = [];
    for (let z = 0; z < nz; ++z) {
      rows.push(Array.from({length: nx}, (_, x) => values_mm[x + nx * (y + ny * z)] ?? null));
    }
    layers.push({y_mm: box.min_mm[1] + (y + 0.5) * cell_mm[1], rows});
  }
  return layers;
}

/** Least and largest value of the map; null when it is empty. */
export function rangeOf({values_mm}: UncertaintyMap): [number, number] | null {
  const known = values_mm.filter((value): value is number => value !== null);
  return known.length > 0 ? [Math.min(...known), Math.max(...known)] : null;
}
