// Poses from outside this project: tests/data/reference_poses.csv tells where they come from.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import type {Frame} from 'page/api/documents.ts';
import {forwardChain} from 'page/model/kinematics.ts';

const root = process.env.TOUCHCAL_SOURCE_DIR ?? '.';
const kPositionErrorMax_mm = 1e-6;  // as kPositionErrorMaxMetres of calib_core/kinematics/kinematic_model.hpp

interface FileFrame { alpha_deg?: number; d_mm?: number; theta_deg?: number; theta_offset_deg?: number; theta_rad?: number; r_mm?: number; beta_deg?: number }

function tx90(): Frame[] {
  const arm = JSON.parse(readFileSync(join(root, 'config/arms/tx90.json'), 'utf8')) as {frames: FileFrame[]};
  const rad = (deg: number | undefined): number => ((deg ?? 0) * Math.PI) / 180;
  return arm.frames.map((frame) => ({
    alpha_rad: rad(frame.alpha_deg), d_mm: frame.d_mm ?? 0,
    theta_rad: frame.theta_rad ?? rad(frame.theta_deg ?? frame.theta_offset_deg), r_mm: frame.r_mm ?? 0, beta_rad: rad(frame.beta_deg),
  }));
}

test('TheArmIsWhereTheReferencePosesSay', () => {
  const lines = readFileSync(join(root, 'tests/data/reference_poses.csv'), 'utf8').split('\n').filter((line) => line.startsWith('nominal,'));
  assert.ok(lines.length > 10);
  for (const line of lines) {
    const values = line.split(',').slice(1).map(Number);
    const [x, y, z] = values.slice(6, 9);
    const rotation = values.slice(9);
    const pose = forwardChain(tx90(), [1, 1, 1, 1, 1, 1], values.slice(0, 6)).pop()!;
    const error = Math.hypot(pose[3] - x!, pose[7] - y!, pose[11] - z!);
    assert.ok(error < kPositionErrorMax_mm, `${line}: ${error} mm`);
    const turned = [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => pose[i]!);
    turned.forEach((value, i) => assert.ok(Math.abs(value - rotation[i]!) < 1e-9, line));
  }
});
