import assert from 'node:assert/strict';
import {test} from 'node:test';
import type {Box, Face, Vector} from 'page/api/documents.ts';
import {blockMeshes, faceMesh, type Mesh} from 'page/scene/meshes.ts';

const kBall = {center_mm: [10, 20, 30] as Vector, radius_mm: 15};
const kCube: Box = {name: 'cube', min_mm: [-75, -75, -75], max_mm: [75, 75, 75]};
const kAroundBall: Box = {name: 'ball of plane 6', min_mm: [-5, 5, 15], max_mm: [25, 35, 45]};
const kOnBall: Face = {plane: 6, outward: [0, 0, 1], offset_mm: 45, center_mm: [10, 20, 45], edge_u: [1, 0, 0], half_extent_mm: [15, 15], sphere: kBall};

function distances_mm(mesh: Mesh): number[] {
  const found: number[] = [];
  for (let i = 0; i < mesh.length; i += 6)
    found.push(Math.hypot(...kBall.center_mm.map((middle, axis) => mesh[i + axis]! - middle)));
  return found;
}

test('ABallIsDrawnInPlaceOfTheCubeAroundIt', () => {
  const {sphere: _, ...flat} = kOnBall;
  assert.equal(blockMeshes([kCube, kAroundBall], [flat]).length, 2);
  const meshes = blockMeshes([kCube, kAroundBall], [flat, kOnBall]);
  assert.equal(meshes.length, 2);
  for (const far of distances_mm(meshes[1]!.mesh)) assert.ok(Math.abs(far - 15) < 1e-4, String(far));
});

test('AFaceThatIsABallShowsAsOneALittleLarger', () => {
  const all = distances_mm(faceMesh(kOnBall));
  assert.ok(all.every((far) => far > 15 && far < 17));
  assert.equal(faceMesh({...kOnBall, sphere: undefined}).length, 6 * 6);
});

const kHole = {center_mm: [20, 0, -10] as Vector, axis: [0, 1, 0] as Vector, radius_mm: 30};
const kRing: Box = {...kCube, holes: [kHole]};

/** Places and normals of a mesh. */
function corners(mesh: Mesh): {point: Vector; normal: Vector}[] {
  const all: {point: Vector; normal: Vector}[] = [];
  for (let i = 0; i < mesh.length; i += 6) all.push({point: [mesh[i]!, mesh[i + 1]!, mesh[i + 2]!], normal: [mesh[i + 3]!, mesh[i + 4]!, mesh[i + 5]!]});
  return all;
}

function area(mesh: Mesh): number {
  const all = corners(mesh).map(({point}) => point);
  let sum = 0;
  for (let i = 0; i < all.length; i += 3) {
    const [a, b, c] = [all[i]!, all[i + 1]!, all[i + 2]!];
    const [p, q] = [b.map((x, k) => x - a[k]!), c.map((x, k) => x - a[k]!)] as [number[], number[]];
    sum += 0.5 * Math.hypot(p[1]! * q[2]! - p[2]! * q[1]!, p[2]! * q[0]! - p[0]! * q[2]!, p[0]! * q[1]! - p[1]! * q[0]!);
  }
  return sum;
}

test('ASolidWithAHoleIsOpenAtBothEndsAndHasAWallInside', () => {
  const mesh = blockMeshes([kRing], [])[0]!.mesh;
  const fromAxis = ({point}: {point: Vector}): number => Math.hypot(point[0] - 20, point[2] + 10);
  for (const corner of corners(mesh)) assert.ok(fromAxis(corner) > 30 - 1e-3, String(corner.point));
  const wanted = 6 * 150 * 150 - 2 * Math.PI * 30 * 30 + 2 * Math.PI * 30 * 150;
  assert.ok(Math.abs(area(mesh) / wanted - 1) < 2e-3, String(area(mesh) / wanted));
});

test('AFaceThatIsABoreShowsAsTheWallThatMayBeTouched', () => {
  const bore = {mouth_mm: [20, 75, -10] as Vector, axis: [0, 1, 0] as Vector, radius_mm: 30, depth_mm: [5, 25] as [number, number], wall_half_angle_deg: 60};
  const face: Face = {plane: 7, outward: [-1, 0, 0], offset_mm: -50, center_mm: [50, 60, -10], edge_u: [0, 1, 0], half_extent_mm: [10, 26], bore};
  for (const {point, normal} of corners(faceMesh(face))) {
    const [x, z] = [point[0] - 20, point[2] + 10];
    assert.ok(point[1] > 50 - 1e-4 && point[1] < 70 + 1e-4);
    assert.ok(Math.abs(Math.hypot(x, z) - 29.2) < 1e-4);
    assert.ok(Math.atan2(Math.abs(z), x) <= Math.PI / 3 + 1e-4);
    assert.ok(normal[0] * x + normal[2] * z < 0, 'towards the axis');
  }
});
