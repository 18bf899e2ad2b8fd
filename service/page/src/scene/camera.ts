import type {Vector} from '../api/documents.ts';
import {lookAt, perspective, times, type Matrix} from './matrix.ts';

/** Looks at a point from around it. The block's frame has its y axis downwards. */
export interface Camera { yaw_rad: number; pitch_rad: number; distance_mm: number; target: Vector }

export const kFirstCamera: Camera = {yaw_rad: 0.75, pitch_rad: 0.35, distance_mm: 2000, target: [-210, -300, 40]};

const kPitchMax_rad = 1.5;
const kView_rad = 0.6;

export function turned(camera: Camera, yaw_rad: number, pitch_rad: number): Camera {
  const pitch = Math.max(-kPitchMax_rad, Math.min(kPitchMax_rad, camera.pitch_rad + pitch_rad));
  return {...camera, yaw_rad: camera.yaw_rad + yaw_rad, pitch_rad: pitch};
}

export function nearer(camera: Camera, factor: number): Camera {
  return {...camera, distance_mm: Math.max(300, Math.min(8000, camera.distance_mm * factor))};
}

export function eyeOf({yaw_rad, pitch_rad, distance_mm, target}: Camera): Vector {
  const flat = Math.cos(pitch_rad) * distance_mm;
  return [target[0] + Math.sin(yaw_rad) * flat, target[1] - Math.sin(pitch_rad) * distance_mm, target[2] + Math.cos(yaw_rad) * flat];
}

export function matrixOf(camera: Camera, aspect: number): Matrix {
  return times(perspective(kView_rad, aspect, camera.distance_mm / 20, camera.distance_mm + 4000),
               lookAt(eyeOf(camera), camera.target, [0, -1, 0]));
}

const kTurnByKey_rad = 0.12;
const kNearerByKey = 0.9;

/** The camera after a key; null when the key means nothing to it. */
export function afterKey(camera: Camera, key: string): Camera | null {
  switch (key) {
    case 'ArrowLeft': return turned(camera, -kTurnByKey_rad, 0);
    case 'ArrowRight': return turned(camera, kTurnByKey_rad, 0);
    case 'ArrowUp': return turned(camera, 0, kTurnByKey_rad);
    case 'ArrowDown': return turned(camera, 0, -kTurnByKey_rad);
    case '+': case '=': return nearer(camera, kNearerByKey);
    case '-': return nearer(camera, 1 / kNearerByKey);
    case '0': return kFirstCamera;
    default: return null;
  }
}
