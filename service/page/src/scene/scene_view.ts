import type {BlockPlace, Cell, Vector} from '../api/documents.ts';
import {forwardChain, kIdentity, placePose} from '../model/kinematics.ts';
import {afterKey, eyeOf, kFirstCamera, matrixOf, nearer, turned, type Camera} from './camera.ts';
import {ofPose, subtract, unit} from './matrix.ts';
import {blockMeshes, boxMesh, capsuleMesh, faceMesh} from './meshes.ts';
import {Painter, type Body, type Color} from './painter.ts';

interface Part { body: Body; frame: number | null; kind: Kind; isMoving?: boolean }
type Kind = 'arm' | 'probe' | 'block' | 'table' | 'face';

interface Palette { ground: Color; parts: Record<Kind, Color>; done: Color; open: Color }
const kLight: Palette = {
  ground: [0.93, 0.93, 0.92],
  parts: {arm: [0.78, 0.78, 0.76], probe: [0.35, 0.36, 0.38], block: [0.62, 0.65, 0.68], table: [0.84, 0.84, 0.82], face: [0.45, 0.55, 0.68]},
  done: [0.1, 0.12, 0.15],
  open: [0.45, 0.45, 0.45],
};
const kDark: Palette = {
  ground: [0.11, 0.12, 0.13],
  parts: {arm: [0.5, 0.51, 0.52], probe: [0.8, 0.8, 0.8], block: [0.4, 0.44, 0.48], table: [0.24, 0.25, 0.26], face: [0.45, 0.6, 0.78]},
  done: [0.95, 0.95, 0.95],
  open: [0.6, 0.6, 0.6],
};

const kTurnByPixel_rad = 0.008;
const kPointSize = 9000;

/** The cell in three dimensions on a canvas; null when this browser draws none. */
export function openScene(canvas: HTMLCanvasElement, cell: Cell): SceneView | null {
  const gl = canvas.getContext('webgl', {antialias: true, alpha: false});
  if (!gl) return null;
  try {
    return new SceneView(canvas, cell, new Painter(gl));
  } catch {
    return null;
  }
}

/** Draws when something changed, and only then. */
export class SceneView {
  private readonly parts: Part[];
  private readonly faces: Map<number, Body>;
  private done: Body;
  private open: Body;
  private camera: Camera = kFirstCamera;
  private joints_deg: number[] | null = null;
  private plane: number | null = null;
  private planeAt: BlockPlace | null = null;
  private blockAt: BlockPlace | null = null;
  private frame = 0;
  private readonly leave = new AbortController();
  private readonly pointers = new Map<number, {x: number; y: number}>();

  constructor(private readonly canvas: HTMLCanvasElement, private readonly cell: Cell, private readonly painter: Painter) {
    const {scene, keep_out_boxes, block} = cell;
    const capsules = (kind: Kind, list: typeof scene.arm_bodies): Part[] =>
        list.map((capsule) => ({body: painter.load(capsuleMesh(capsule)), frame: capsule.frame, kind}));
    this.parts = [
      ...blockMeshes(scene.solids, block.faces)
          .map(({mesh, isMoving}): Part => ({body: painter.load(mesh), frame: null, kind: 'block', isMoving})),
      ...keep_out_boxes.map((box): Part => ({body: painter.load(boxMesh(box)), frame: null, kind: 'table'})),
      ...capsules('arm', scene.arm_bodies),
      ...capsules('probe', scene.probe_bodies),
    ];
    this.faces = new Map(block.faces.map((face) => [face.plane, painter.load(faceMesh(face))]));
    this.done = painter.loadPoints([]);
    this.open = painter.loadPoints([]);
    this.listen();
    this.ask();
  }

  close(): void {
    cancelAnimationFrame(this.frame);
    this.leave.abort();
    for (const body of [...this.parts.map((part) => part.body), ...this.faces.values(), this.done, this.open]) this.painter.drop(body);
  }

  /** Null: where the arm is, is not known; it stays where it was last. */
  setJoints(joints_deg: number[] | null): void {
    if (!joints_deg || this.joints_deg?.every((joint, i) => joint === joints_deg[i])) return;
    this.joints_deg = joints_deg;
    this.ask();
  }

  /** One of the block's own planes, and the further place at which it is touched. */
  setPlane(plane: number | null, at: BlockPlace | null): void {
    if (plane === this.plane && at === this.planeAt) return;
    this.plane = plane;
    this.planeAt = at;
    this.ask();
  }

  /** The further place at which the block stands; null: the first one. */
  setBlock(at: BlockPlace | null): void {
    if (at === this.blockAt) return;
    this.blockAt = at;
    this.ask();
  }

  setTouches(done: Vector[], open: Vector[]): void {
    this.painter.drop(this.done);
    this.painter.drop(this.open);
    this.done = this.painter.loadPoints(done);
    this.open = this.painter.loadPoints(open);
    this.ask();
  }

  resetCamera(): void {
    this.camera = kFirstCamera;
    this.ask();
  }

  turnByKey(key: string): boolean {
    const camera = afterKey(this.camera, key);
    if (!camera) return false;
    this.camera = camera;
    this.ask();
    return true;
  }

  private ask(): void {
    if (!this.frame) this.frame = requestAnimationFrame(() => this.draw());
  }

  private draw(): void {
    this.frame = 0;
    const {canvas, painter, cell} = this;
    const sharpness = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [Math.round(canvas.clientWidth * sharpness), Math.round(canvas.clientHeight * sharpness)];
    if (width < 1 || height < 1) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const palette = document.documentElement.dataset.theme === 'dark' ? kDark : kLight;
    const camera = matrixOf(this.camera, width / height);
    const light = unit(subtract(eyeOf(this.camera), this.camera.target));
    const chain = forwardChain(cell.scene.frames, cell.scene.gains, this.joints_deg ?? cell.scene.park_joints_deg);
    const placed = (at: BlockPlace | null) => ofPose(at === null ? kIdentity : placePose(at));
    const [rest, block] = [placed(null), placed(this.blockAt)];
    painter.begin(width, height, palette.ground);
    for (const {body, frame, kind, isMoving} of this.parts) {
      const pose = frame === null ? (isMoving ? block : rest) : ofPose(chain[frame] ?? kIdentity);
      painter.drawSolid(body, camera, pose, palette.parts[kind], light);
    }
    const face = this.plane === null ? undefined : this.faces.get(this.plane);
    if (face) painter.drawSolid(face, camera, placed(this.planeAt), palette.parts.face, light);
    painter.drawPoints(this.open, camera, palette.open, kPointSize * sharpness, 0.32);
    painter.drawPoints(this.done, camera, palette.done, kPointSize * sharpness, 0);
  }

  private listen(): void {
    const {canvas, pointers} = this;
    const signal = this.leave.signal;
    const on = <K extends keyof HTMLElementEventMap>(name: K, act: (event: HTMLElementEventMap[K]) => void): void =>
        canvas.addEventListener(name, act, {signal, passive: false});
    on('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    });
    on('pointermove', (event) => this.drag(event));
    for (const name of ['pointerup', 'pointercancel'] as const) on(name, (event) => pointers.delete(event.pointerId));
    on('wheel', (event) => {
      event.preventDefault();
      this.camera = nearer(this.camera, Math.exp(event.deltaY * 0.001));
      this.ask();
    });
    const watch = new ResizeObserver(() => this.ask());
    watch.observe(canvas);
    const theme = new MutationObserver(() => this.ask());
    theme.observe(document.documentElement, {attributeFilter: ['data-theme']});
    signal.addEventListener('abort', () => {
      watch.disconnect();
      theme.disconnect();
    });
  }

  /** One pointer turns, two come nearer. */
  private drag(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = {x: event.clientX, y: event.clientY};
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (point: {x: number; y: number}): number => Math.max(1, Math.hypot(point.x - other.x, point.y - other.y));
      this.camera = nearer(this.camera, apart(before) / apart(now));
    } else {
      this.camera = turned(this.camera, -(now.x - before.x) * kTurnByPixel_rad, (now.y - before.y) * kTurnByPixel_rad);
    }
    this.pointers.set(event.pointerId, now);
    this.ask();
  }
}
