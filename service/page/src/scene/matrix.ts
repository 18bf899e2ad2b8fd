import type {Vector} from '../api/documents.ts';
import type {Pose} from '../model/kinematics.ts';

/** 4 x 4, column by column, as WebGL takes it. */
export type Matrix = Float32Array;

export const subtract = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scale = (a: Vector, factor: number): Vector => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector =>
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a: Vector): number => Math.hypot(...a);
export const unit = (a: Vector): Vector => scale(a, 1 / (length(a) || 1));

export function ofPose(pose: Pose): Matrix {
  const [a, b, c, x, d, e, f, y, g, h, i, z] = pose;
  return new Float32Array([a, d, g, 0, b, e, h, 0, c, f, i, 0, x, y, z, 1]);
}

export function times(a: Matrix, b: Matrix): Matrix {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[4 * k + row]! * b[4 * column + k]!;
      out[4 * column + row] = sum;
    }
  }
  return out;
}

export function perspective(view_rad: number, aspect: number, near: number, far: number): Matrix {
  const f = 1 / Math.tan(view_rad / 2);
  return new Float32Array([
    f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0,
  ]);
}

export function lookAt(eye: Vector, target: Vector, up: Vector): Matrix {
  const back = unit(subtract(eye, target));
  const right = unit(cross(up, back));
  const over = cross(back, right);
  return new Float32Array([
    right[0], over[0], back[0], 0, right[1], over[1], back[1], 0, right[2], over[2], back[2], 0,
    -dot(right, eye), -dot(over, eye), -dot(back, eye), 1,
  ]);
}
