import type {Box, Capsule, Face, Vector} from '../api/documents.ts';
import {holedBoxMesh, wallTriangles} from './holes.ts';
import {add, cross, length, scale, subtract, unit} from './matrix.ts';

/** Triangles: six numbers a corner, place (mm) and normal. */
export type Mesh = Float32Array;

function push(out: number[], point: Vector, normal: Vector): void {
  out.push(...point, ...normal);
}

export function boxMesh({min_mm, max_mm}: Pick<Box, 'min_mm' | 'max_mm'>): Mesh {
  const out: number[] = [];
  for (let axis = 0; axis < 3; ++axis) {
    for (const side of [0, 1]) {
      const normal: Vector = [0, 0, 0];
      normal[axis] = side ? 1 : -1;
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3] as [0 | 1 | 2, 0 | 1 | 2];
      const corner = (a: number, b: number): Vector => {
        const point: Vector = [0, 0, 0];
        point[axis] = (side ? max_mm : min_mm)[axis]!;
        point[u] = (a ? max_mm : min_mm)[u];
        point[v] = (b ? max_mm : min_mm)[v];
        return point;
      };
      for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]] as const) push(out, corner(a, b), normal);
    }
  }
  return new Float32Array(out);
}

const kAround = 24;
const kCap = 6;

/** All points within a radius of a segment; a ball when its ends are one. */
export function capsuleMesh({from_mm, to_mm, radius_mm}: Pick<Capsule, 'from_mm' | 'to_mm' | 'radius_mm'>): Mesh {
  const axis = subtract(to_mm, from_mm);
  const along = length(axis) > 1e-9 ? unit(axis) : ([0, 0, 1] as Vector);
  const side = unit(cross(along, Math.abs(along[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
  const other = cross(along, side);
  // Rings from one pole to the other: half a ball about `from`, then half a ball about `to`.
  const rings: {center: Vector; angle: number}[] = [];
  for (let i = 0; i <= kCap; ++i) rings.push({center: from_mm, angle: -Math.PI / 2 + (i / kCap) * (Math.PI / 2)});
  for (let i = 0; i <= kCap; ++i) rings.push({center: to_mm, angle: (i / kCap) * (Math.PI / 2)});
  const normal = (angle: number, turn: number): Vector =>
      add(scale(along, Math.sin(angle)), scale(add(scale(side, Math.cos(turn)), scale(other, Math.sin(turn))), Math.cos(angle)));
  const out: number[] = [];
  for (let i = 0; i + 1 < rings.length; ++i) {
    for (let j = 0; j < kAround; ++j) {
      const corner = (ring: number, step: number): void => {
        const {center, angle} = rings[ring]!;
        const out_ward = normal(angle, (2 * Math.PI * step) / kAround);
        push(out, add(center, scale(out_ward, radius_mm)), out_ward);
      };
      for (const [ring, step] of [[i, j], [i, j + 1], [i + 1, j + 1], [i, j], [i + 1, j + 1], [i + 1, j]] as const)
        corner(ring, step);
    }
  }
  return new Float32Array(out);
}

const ballMesh = (center_mm: Vector, radius_mm: number): Mesh => capsuleMesh({from_mm: center_mm, to_mm: center_mm, radius_mm});

/** `isMoving`: it goes with the block to another place. */
export interface BlockMesh { mesh: Mesh; isMoving: boolean }

const kOnSolid_mm = 1;

/** The solid on which the first face lies, which is what a person lifts; null: there is none, and all of them are. */
function firstSolid(solids: Box[], faces: Face[]): Box | null {
  const on = faces[0]?.center_mm;
  if (!on) return null;
  const inside_mm = ({min_mm, max_mm}: Box): number =>
      Math.min(...on.map((middle, axis) => Math.min(middle - min_mm[axis]!, max_mm[axis]! - middle)));
  return solids.find((box) => Math.abs(inside_mm(box)) < kOnSolid_mm) ?? null;
}

/** The solids of a block. Of a ball the cell tells the cube around it: in its place is the ball. */
export function blockMeshes(solids: Box[], faces: Face[]): BlockMesh[] {
  const balls = faces.flatMap(({sphere}) => sphere ?? []);
  const isAround = ({min_mm, max_mm}: Box): boolean => balls.some(({center_mm, radius_mm}) =>
      center_mm.every((middle, axis) =>
          Math.abs(min_mm[axis]! - middle + radius_mm) < 1e-6 && Math.abs(max_mm[axis]! - middle - radius_mm) < 1e-6));
  const first = firstSolid(solids, faces);
  return [
    ...solids.filter((box) => !isAround(box)).map((box): BlockMesh =>
        ({mesh: box.holes?.length ? holedBoxMesh(box, box.holes) : boxMesh(box), isMoving: first === null || box === first})),
    ...balls.map(({center_mm, radius_mm}): BlockMesh => ({mesh: ballMesh(center_mm, radius_mm), isMoving: true})),
  ];
}

const kLift_mm = 0.8;

function boreMesh({mouth_mm, axis, radius_mm, depth_mm, wall_half_angle_deg}: NonNullable<Face['bore']>, outward: Vector): Mesh {
  const out: number[] = [];
  const along = [-depth_mm[1], -depth_mm[0]] as const;
  wallTriangles(out, mouth_mm, axis, radius_mm - kLift_mm, along, scale(outward, -1), (wall_half_angle_deg * Math.PI) / 180);
  return new Float32Array(out);
}

/** The part of a face that may be touched, of a ball the whole, lifted a little off the block so that it shows. */
export function faceMesh({outward, center_mm, edge_u, half_extent_mm, sphere, bore}: Face): Mesh {
  if (sphere) return ballMesh(sphere.center_mm, sphere.radius_mm + kLift_mm);
  if (bore) return boreMesh(bore, outward);
  const edge_v = cross(outward, edge_u);
  const out: number[] = [];
  for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]] as const) {
    const in_face = add(scale(edge_u, a * half_extent_mm[0]), scale(edge_v, b * half_extent_mm[1]));
    push(out, add(add(center_mm, scale(outward, kLift_mm)), in_face), outward);
  }
  return new Float32Array(out);
}
