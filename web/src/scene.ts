// Draws discs, lines and polygons with WebGL2: one call for all shapes of a kind, and none if the picture has not changed.

const DISC_VERTEX = `#version 300 es
layout(location=0) in vec2 corner;
layout(location=1) in vec4 body;   // x, y, radius, angle
layout(location=2) in vec4 color;
layout(location=3) in vec3 form;   // cosine of the mouth's half angle (2 for none), width of a ring (0 for none), angle of its middle
uniform vec3 view;                 // center, then pixels per unit
uniform vec2 half_size;            // of the canvas [pixel]
out vec2 at; out vec4 tint; out vec2 shape; out float pixel; out vec2 ahead; out vec2 middle;
void main() {
  float grown = body.z + 1.0 / view.z;
  at = corner * grown / body.z;
  pixel = 1.0 / (body.z * view.z);
  tint = color; shape = form.xy;
  ahead = vec2(-sin(body.w), cos(body.w));
  middle = vec2(-sin(body.w + form.z), cos(body.w + form.z));
  gl_Position = vec4((body.xy + corner * grown - view.xy) * view.z / half_size, 0.0, 1.0);
}`;
const DISC_FRAGMENT = `#version 300 es
precision highp float;
in vec2 at; in vec4 tint; in vec2 shape; in float pixel; in vec2 ahead; in vec2 middle;
out vec4 color;
void main() {
  float r = length(at);
  float inside = clamp((1.0 - r) / pixel + 0.5, 0.0, 1.0);
  vec3 base = tint.rgb;
  if (shape.x < 1.5) {
    float front = dot(at, middle) / max(r, 1e-6);
    float mouth = smoothstep(0.80, 0.86, r) * step(shape.x, front);
    base = mix(base, vec3(0.93, 0.2, 0.2), mouth);
    // Two eyes where there is room for them, one dark spot on small discs. Their white is darker than any ground.
    vec2 aside = vec2(abs(dot(at, vec2(ahead.y, -ahead.x))), dot(at, ahead));
    float large = smoothstep(0.16, 0.10, pixel);
    base = mix(base, vec3(0.88, 0.91, 0.95), large * (1.0 - smoothstep(0.26 - pixel, 0.26 + pixel, length(aside - vec2(0.34, 0.48)))));
    base = mix(base, vec3(0.05), large * (1.0 - smoothstep(0.13 - pixel, 0.13 + pixel, length(aside - vec2(0.37, 0.57)))));
    base = mix(base, vec3(0.05), (1.0 - large) * (1.0 - smoothstep(0.14, 0.14 + pixel * 2.0, length(at - 0.5 * ahead))));
    base *= 1.0 - 0.35 * smoothstep(0.90, 1.0, r) * (1.0 - mouth);
  }
  if (shape.y > 0.0) inside *= smoothstep(1.0 - shape.y - pixel, 1.0 - shape.y, r);
  color = vec4(base, 1.0) * tint.a * inside;
}`;
const LINE_VERTEX = `#version 300 es
layout(location=0) in vec2 place;
layout(location=1) in vec4 color;
uniform vec3 view; uniform vec2 half_size; out vec4 tint;
void main() { tint = color; gl_Position = vec4((place - view.xy) * view.z / half_size, 0.0, 1.0); }`;
const LINE_FRAGMENT = `#version 300 es
precision highp float;
in vec4 tint; out vec4 color;
void main() { color = vec4(tint.rgb * tint.a, tint.a); }`;

const DISC_WORDS = 8; // x, y, radius, angle, color, mouth, ring, middle of the mouth
const LINE_WORDS = 3; // x, y, color; also for the corners of triangles

/** Shapes of one kind, in a buffer that only grows. */
class Batch {
  floats = new Float32Array(1024);
  words = new Uint32Array(this.floats.buffer);
  used = 0;
  private shown = new Uint32Array(0); // words of the last picture

  constructor(readonly width: number) {}

  /** Adds a shape; returns the index of its first word. */
  next(): number {
    if (this.used + this.width > this.floats.length) {
      const larger = new Float32Array(this.floats.length * 2);
      larger.set(this.floats);
      this.floats = larger;
      this.words = new Uint32Array(larger.buffer);
    }
    this.used += this.width;
    return this.used - this.width;
  }

  get count(): number {
    return this.used / this.width;
  }

  /** Whether the shapes differ from those at the last call. */
  changed(): boolean {
    const { words, used, shown } = this;
    let at = shown.length === used ? 0 : -1;
    while (at >= 0 && at < used && words[at] === shown[at]) at++;
    if (at === used) return false;
    this.shown = words.slice(0, used);
    return true;
  }
}

export class Scene {
  centerX = 0;
  centerY = 0;
  zoom = 1; // pixels of the canvas per unit
  enlarged = 1; // factor by which the canvas exceeds the pixels of the screen
  private readonly gl: WebGL2RenderingContext;
  private readonly discs = new Batch(DISC_WORDS);
  private readonly lines = new Batch(LINE_WORDS);
  private readonly triangles = new Batch(LINE_WORDS);
  private discProgram!: WebGLProgram;
  private lineProgram!: WebGLProgram;
  private discArray!: WebGLVertexArrayObject;
  private lineArray!: WebGLVertexArrayObject;
  private discBuffer!: WebGLBuffer;
  private lineBuffer!: WebGLBuffer;
  lost = false; // whether the browser has taken away the WebGL context, as it may at any time
  private shown = ""; // key of the last picture's view

  constructor(readonly canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.build();
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // otherwise the context is never restored
      this.lost = true;
    });
    canvas.addEventListener("webglcontextrestored", () => this.build());
  }

  private build(): void {
    const { gl } = this;
    this.discProgram = link(gl, DISC_VERTEX, DISC_FRAGMENT);
    this.lineProgram = link(gl, LINE_VERTEX, LINE_FRAGMENT);
    [this.discArray, this.discBuffer] = this.discLayout();
    [this.lineArray, this.lineBuffer] = this.lineLayout();
    this.lost = false;
    this.shown = "";
  }

  begin(): void {
    this.discs.used = this.lines.used = this.triangles.used = 0;
  }

  disc(x: number, y: number, radius: number, color: number, angle = 0, mouth = 2, ring = 0, middle = 0): void {
    const at = this.discs.next();
    const { floats, words } = this.discs;
    floats[at] = x;
    floats[at + 1] = y;
    floats[at + 2] = radius;
    floats[at + 3] = angle;
    words[at + 4] = color;
    floats[at + 5] = mouth;
    floats[at + 6] = ring;
    floats[at + 7] = middle;
  }

  line(x0: number, y0: number, x1: number, y1: number, color: number): void {
    this.corner(this.lines, x0, y0, color);
    this.corner(this.lines, x1, y1, color);
  }

  /** Adds a convex polygon. */
  polygon(corners: [number, number][], color: number): void {
    for (let i = 2; i < corners.length; i++) {
      for (const [x, y] of [corners[0]!, corners[i - 1]!, corners[i]!]) this.corner(this.triangles, x, y, color);
    }
  }

  /** Draws everything added since `begin`, on a background color with components from 0 to 1. */
  end(background: [number, number, number]): void {
    const { gl, canvas } = this;
    if (this.lost) return;
    const view = [this.centerX, this.centerY, this.zoom, canvas.width, canvas.height, ...background].join();
    const changed = [this.discs, this.lines, this.triangles].filter((each) => each.changed()).length > 0;
    if (!changed && view === this.shown) return;
    this.shown = view;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.use(this.lineProgram, this.lineArray, this.lineBuffer, this.triangles);
    gl.drawArrays(gl.TRIANGLES, 0, this.triangles.count);
    this.use(this.lineProgram, this.lineArray, this.lineBuffer, this.lines);
    gl.drawArrays(gl.LINES, 0, this.lines.count);
    this.use(this.discProgram, this.discArray, this.discBuffer, this.discs);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.discs.count);
  }

  /** The place in the world under a pixel of the page. */
  toWorld(clientX: number, clientY: number): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const scale = this.canvas.width / box.width;
    const dx = (clientX - box.left) * scale - this.canvas.width / 2;
    const dy = (clientY - box.top) * scale - this.canvas.height / 2;
    return [this.centerX + dx / this.zoom, this.centerY - dy / this.zoom];
  }

  /** The position of a place in the world, in pixels of the page relative to the canvas. */
  toPage(x: number, y: number): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const scale = box.width / this.canvas.width;
    const px = ((x - this.centerX) * this.zoom + this.canvas.width / 2) * scale;
    const py = ((this.centerY - y) * this.zoom + this.canvas.height / 2) * scale;
    return [box.left + px, box.top + py];
  }

  /** Fits the canvas to its size on the page; returns whether its size has changed. */
  resize(): boolean {
    const ratio = this.enlarged * Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [Math.round(this.canvas.clientWidth * ratio), Math.round(this.canvas.clientHeight * ratio)];
    if (width === this.canvas.width && height === this.canvas.height) return false;
    [this.canvas.width, this.canvas.height] = [width, height];
    return true;
  }

  private corner(batch: Batch, x: number, y: number, color: number): void {
    const at = batch.next();
    batch.floats[at] = x;
    batch.floats[at + 1] = y;
    batch.words[at + 2] = color;
  }

  private use(program: WebGLProgram, array: WebGLVertexArrayObject, buffer: WebGLBuffer, batch: Batch): void {
    const { gl, canvas } = this;
    gl.useProgram(program);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, batch.floats.subarray(0, batch.used), gl.STREAM_DRAW);
    gl.uniform3f(gl.getUniformLocation(program, "view"), this.centerX, this.centerY, this.zoom);
    gl.uniform2f(gl.getUniformLocation(program, "half_size"), canvas.width / 2, canvas.height / 2);
  }

  private discLayout(): [WebGLVertexArrayObject, WebGLBuffer] {
    const { gl } = this;
    const array = gl.createVertexArray()!;
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    const buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    const stride = DISC_WORDS * 4;
    gl.vertexAttribPointer(1, 4, gl.FLOAT, false, stride, 0);
    gl.vertexAttribPointer(2, 4, gl.UNSIGNED_BYTE, true, stride, 16);
    gl.vertexAttribPointer(3, 3, gl.FLOAT, false, stride, 20);
    for (const at of [1, 2, 3]) {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribDivisor(at, 1);
    }
    return [array, buffer];
  }

  private lineLayout(): [WebGLVertexArrayObject, WebGLBuffer] {
    const { gl } = this;
    const array = gl.createVertexArray()!;
    gl.bindVertexArray(array);
    const buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, LINE_WORDS * 4, 0);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, LINE_WORDS * 4, 8);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    return [array, buffer];
  }
}

function link(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram {
  const program = gl.createProgram()!;
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "no program");
  return program;
}
