import type {Vector} from '../api/documents.ts';
import type {Matrix} from './matrix.ts';
import type {Mesh} from './meshes.ts';

export type Color = [number, number, number];

/** A mesh on the graphics card. */
export interface Body { buffer: WebGLBuffer; count: number }

const kSolidVertex = `
attribute vec3 place; attribute vec3 normal; uniform mat4 camera; uniform mat4 pose; varying vec3 turned;
void main() { turned = mat3(pose) * normal; gl_Position = camera * pose * vec4(place, 1.0); }`;
const kSolidFragment = `
precision mediump float; varying vec3 turned; uniform vec3 color; uniform vec3 light;
void main() { float shade = 0.62 + 0.38 * dot(normalize(turned), light); gl_FragColor = vec4(color * shade, 1.0); }`;
const kPointVertex = `
attribute vec3 place; uniform mat4 camera; uniform float size;
void main() { gl_Position = camera * vec4(place, 1.0); gl_PointSize = max(3.0, size / gl_Position.w); }`;
const kPointFragment = `
precision mediump float; uniform vec3 color; uniform float hollow;
void main() { float d = length(gl_PointCoord - 0.5); if (d > 0.5 || d < hollow) discard; gl_FragColor = vec4(color, 1.0); }`;

/**
 * Draws lit bodies and points by WebGL 1, which every browser and software renderer has. By hand rather than with
 * three.js: two shaders are all that the view needs, and the library is larger than the whole page.
 */
export class Painter {
  private readonly solid: WebGLProgram;
  private readonly point: WebGLProgram;

  constructor(private readonly gl: WebGLRenderingContext) {
    this.solid = program(gl, kSolidVertex, kSolidFragment);
    this.point = program(gl, kPointVertex, kPointFragment);
    gl.enable(gl.DEPTH_TEST);
  }

  load(mesh: Mesh, floats = 6): Body {
    const {gl} = this;
    const buffer = gl.createBuffer();
    if (!buffer) throw new Error('the graphics card has no room');
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, mesh, gl.STATIC_DRAW);
    return {buffer, count: mesh.length / floats};
  }

  loadPoints(points: Vector[]): Body {
    return this.load(new Float32Array(points.flat()), 3);
  }

  drop(body: Body): void {
    this.gl.deleteBuffer(body.buffer);
  }

  begin(width: number, height: number, ground: Color): void {
    const {gl} = this;
    gl.viewport(0, 0, width, height);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  drawSolid(body: Body, camera: Matrix, pose: Matrix, color: Color, light: Vector): void {
    const {gl, solid} = this;
    gl.useProgram(solid);
    gl.uniformMatrix4fv(gl.getUniformLocation(solid, 'camera'), false, camera);
    gl.uniformMatrix4fv(gl.getUniformLocation(solid, 'pose'), false, pose);
    gl.uniform3fv(gl.getUniformLocation(solid, 'color'), color);
    gl.uniform3fv(gl.getUniformLocation(solid, 'light'), light);
    gl.bindBuffer(gl.ARRAY_BUFFER, body.buffer);
    this.attribute(solid, 'place', 24, 0);
    this.attribute(solid, 'normal', 24, 12);
    gl.drawArrays(gl.TRIANGLES, 0, body.count);
  }

  /** `hollow`: the radius of the hole, of 0.5. */
  drawPoints(body: Body, camera: Matrix, color: Color, size: number, hollow: number): void {
    if (body.count === 0) return;
    const {gl, point} = this;
    gl.useProgram(point);
    gl.uniformMatrix4fv(gl.getUniformLocation(point, 'camera'), false, camera);
    gl.uniform3fv(gl.getUniformLocation(point, 'color'), color);
    gl.uniform1f(gl.getUniformLocation(point, 'size'), size);
    gl.uniform1f(gl.getUniformLocation(point, 'hollow'), hollow);
    gl.bindBuffer(gl.ARRAY_BUFFER, body.buffer);
    this.attribute(point, 'place', 12, 0);
    gl.drawArrays(gl.POINTS, 0, body.count);
  }

  private attribute(of: WebGLProgram, name: string, stride: number, offset: number): void {
    const {gl} = this;
    const place = gl.getAttribLocation(of, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 3, gl.FLOAT, false, stride, offset);
  }
}

function program(gl: WebGLRenderingContext, vertex: string, fragment: string): WebGLProgram {
  const made = gl.createProgram();
  if (!made) throw new Error('the graphics card takes no program');
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(kind);
    if (!shader) throw new Error('the graphics card takes no program');
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made) ?? 'no program');
  return made;
}
