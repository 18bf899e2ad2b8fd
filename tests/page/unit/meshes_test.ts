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
  for (const far of distances_mm(meshes[1]!)) assert.ok(Math.abs(far - 15) < 1e-4, String(far));
});

test('AFaceThatIsABallShowsAsOneALittleLarger', () => {
  const all = distances_mm(faceMesh(kOnBall));
  assert.ok(all.every((far) => far > 15 && far < 17));
  assert.equal(faceMesh({...kOnBall, sphere: undefined}).length, 6 * 6);
});
