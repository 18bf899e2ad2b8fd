import type {BlockPlace, Frame, Vector} from '../api/documents.ts';

/** A rigid transform: rows of the rotation and the translation in mm, row by row, 3 x 4. */
export type Pose = [number, number, number, number, number, number, number, number, number, number, number, number];

export const kIdentity: Pose = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

const kRadiansPerDegree = Math.PI / 180;

export function multiply(a: Pose, b: Pose): Pose {
  const out = [...kIdentity] as Pose;
  for (let row = 0; row < 3; ++row) {
    const [x, y, z, t] = a.slice(4 * row, 4 * row + 4) as [number, number, number, number];
    for (let column = 0; column < 4; ++column) {
      const sum = x * b[column]! + y * b[4 + column]! + z * b[8 + column]!;
      out[4 * row + column] = column === 3 ? sum + t : sum;
    }
  }
  return out;
}

/** Rot(y,beta) Rot(x,alpha) Trans(x,d) Rot(z,theta) Trans(z,r): Khalil and Kleinfinger's modified DH with Hayati's beta. */
export function frameTransform({alpha_rad, d_mm, theta_rad, r_mm, beta_rad}: Frame): Pose {
  const [ca, sa] = [Math.cos(alpha_rad), Math.sin(alpha_rad)];
  const [cb, sb] = [Math.cos(beta_rad), Math.sin(beta_rad)];
  const [ct, st] = [Math.cos(theta_rad), Math.sin(theta_rad)];
  const bend: Pose = [cb, sb * sa, sb * ca, cb * d_mm, 0, ca, -sa, 0, -sb, cb * sa, cb * ca, -sb * d_mm];
  return multiply(bend, [ct, -st, 0, 0, st, ct, 0, 0, 0, 0, 1, r_mm]);
}

/** A rotation vector and a shift: of another place of the block, in R_-1 of the first one. */
export function placePose({shift_mm, turn_deg}: Pick<BlockPlace, 'shift_mm' | 'turn_deg'>): Pose {
  const turn_rad = Math.hypot(...turn_deg) * kRadiansPerDegree;
  const [x, y, z] = turn_deg.map((part) => (turn_rad > 0 ? (part * kRadiansPerDegree) / turn_rad : 0)) as Vector;
  const [c, s] = [Math.cos(turn_rad), Math.sin(turn_rad)];
  const d = 1 - c;
  return [
    c + d * x * x, d * x * y - s * z, d * x * z + s * y, shift_mm[0],
    d * x * y + s * z, c + d * y * y, d * y * z - s * x, shift_mm[1],
    d * x * z - s * y, d * y * z + s * x, c + d * z * z, shift_mm[2],
  ];
}

/** Frames 0 to 7 of the arm in the block's frame R_-1; 7 ends in the centre of the stylus ball. */
export function forwardChain(frames: Frame[], gains: number[], joints_deg: number[]): Pose[] {
  const chain: Pose[] = [];
  let pose = kIdentity;
  frames.forEach((frame, j) => {
    const isJoint = j >= 1 && j <= 6;
    const turn = isJoint ? (gains[j - 1] ?? 1) * (joints_deg[j - 1] ?? 0) * kRadiansPerDegree : 0;
    pose = multiply(pose, frameTransform({...frame, theta_rad: frame.theta_rad + turn}));
    chain.push(pose);
  });
  return chain;
}

export function apply(pose: Pose, point: Vector): Vector {
  const [x, y, z] = point;
  const row = (i: number): number => pose[i]! * x + pose[i + 1]! * y + pose[i + 2]! * z + pose[i + 3]!;
  return [row(0), row(4), row(8)];
}

/** The centre of the stylus ball, in R_-1. */
export function tip_mm(frames: Frame[], gains: number[], joints_deg: number[], ball_mm: Vector = [0, 0, 0]): Vector {
  return apply(forwardChain(frames, gains, joints_deg).pop() ?? kIdentity, ball_mm);
}
