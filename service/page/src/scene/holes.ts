import type {Box, Hole, Vector} from '../api/documents.ts';
import {add, cross, dot, scale, subtract, unit} from './matrix.ts';

/** Sides of a box with holes in them, and the walls of the holes; triangles as in meshes.ts. */

const kStrips = 48;
const kAround = 48;

/** A part of the wall of a round hole, seen from its axis: between two places along it, within an angle of a middle. */
export function wallTriangles(
  out: number[], on_axis_mm: Vector, axis: Vector, radius_mm: number, along_mm: readonly [number, number], middle: Vector, half_angle_rad: number): void {
  const across = cross(axis, middle);
  const corner = (step: number, along: number): void => {
    const angle = half_angle_rad * ((2 * step) / kAround - 1);
    const way = add(scale(middle, Math.cos(angle)), scale(across, Math.sin(angle)));
    out.push(...add(add(on_axis_mm, scale(axis, along)), scale(way, radius_mm)), ...scale(way, -1));
  };
  const [from, to] = along_mm;
  for (let i = 0; i < kAround; ++i) {
    for (const [step, along] of [[i, from], [i + 1, from], [i + 1, to], [i, from], [i + 1, to], [i, to]] as const) corner(step, along);
  }
}

/** Where the axis of a hole meets the side of a box across it: how far from its centre. */
const alongToSide = ({center_mm, axis}: Hole, side: number, place_mm: number): number => (place_mm - center_mm[side]!) / axis[side]!;

const mainAxis = ({axis}: Hole): number => [0, 1, 2].reduce((most, each) => (Math.abs(axis[each]!) > Math.abs(axis[most]!) ? each : most), 0);

/** A side of a box without what the holes take out of it: strips along u, each cut where a hole is. */
function sideTriangles(out: number[], box: Box, holes: Hole[], axis: number, is_far: boolean): void {
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const place = (is_far ? box.max_mm : box.min_mm)[axis]!;
  const normal: Vector = [0, 0, 0];
  normal[axis] = is_far ? 1 : -1;
  const openings = holes.filter((hole) => mainAxis(hole) === axis).map((hole) => {
    const middle = add(hole.center_mm, scale(hole.axis, alongToSide(hole, axis, place)));
    return {u: middle[u]!, v: middle[v]!, radius: hole.radius_mm};
  });
  const corner = (at_u: number, at_v: number): void => {
    const point: Vector = [0, 0, 0];
    point[axis] = place;
    point[u] = at_u;
    point[v] = at_v;
    out.push(...point, ...normal);
  };
  const cuts = new Set<number>([box.min_mm[u]!, box.max_mm[u]!]);
  for (const {u: middle, radius} of openings)
    for (let i = 0; i <= kStrips; ++i) cuts.add(middle - radius * Math.cos((Math.PI * i) / kStrips));
  const sorted = [...cuts].sort((a, b) => a - b);
  for (let i = 0; i + 1 < sorted.length; ++i) {
    const [from, to] = [sorted[i]!, sorted[i + 1]!];
    const chord = ({u: middle, radius}: {u: number; radius: number}, at: number): number => Math.sqrt(Math.max(0, radius ** 2 - (at - middle) ** 2));
    const cut = openings.filter((hole) => Math.abs(0.5 * (from + to) - hole.u) < hole.radius).sort((a, b) => a.v - b.v);
    let [low_from, low_to] = [box.min_mm[v]!, box.min_mm[v]!];
    const quad = (high_from: number, high_to: number): void => {
      for (const [at_u, at_v] of [[from, low_from], [to, low_to], [to, high_to], [from, low_from], [to, high_to], [from, high_from]] as const)
        corner(at_u, at_v);
    };
    for (const hole of cut) {
      quad(hole.v - chord(hole, from), hole.v - chord(hole, to));
      [low_from, low_to] = [hole.v + chord(hole, from), hole.v + chord(hole, to)];
    }
    quad(box.max_mm[v]!, box.max_mm[v]!);
  }
}

export function holedBoxMesh(box: Box, holes: Hole[]): Float32Array {
  const out: number[] = [];
  for (const axis of [0, 1, 2]) for (const is_far of [false, true]) sideTriangles(out, box, holes, axis, is_far);
  for (const hole of holes) {
    const main = mainAxis(hole);
    const ends = [alongToSide(hole, main, box.min_mm[main]!), alongToSide(hole, main, box.max_mm[main]!)] as const;
    const beside: Vector = [0, 0, 0];
    beside[(main + 1) % 3] = 1;
    const middle = unit(subtract(beside, scale(hole.axis, dot(beside, hole.axis))));
    wallTriangles(out, hole.center_mm, hole.axis, hole.radius_mm, ends, middle, Math.PI);
  }
  return new Float32Array(out);
}
