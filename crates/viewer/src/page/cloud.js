// A point cloud with boxes that turns.

import { prepared } from "/plots.js";

const POINT_SHADER = `
attribute vec4 point; uniform mat4 view; uniform vec2 heights; uniform float size; varying vec3 colour;
void main() {
  gl_Position = view * vec4(point.xyz, 1.0);
  gl_PointSize = size;
  float share = clamp((point.z - heights.x) / max(heights.y - heights.x, 0.001), 0.0, 1.0);
  colour = mix(mix(vec3(0.20, 0.36, 0.75), vec3(0.25, 0.80, 0.70), min(share * 2.0, 1.0)), vec3(1.0, 0.85, 0.40), max(share * 2.0 - 1.0, 0.0));
}`;
const LINE_SHADER = `
attribute vec4 point; uniform mat4 view; varying vec3 colour;
void main() { gl_Position = view * vec4(point.xyz, 1.0); colour = vec3(1.0, 0.45, 0.45); }`;
const FRAGMENT_SHADER = `precision mediump float; varying vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }`;
// Corners 0 to 3 are those of the base; bit 0 is along, bit 1 across.
const EDGES = [0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7, 7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7];

export class Cloud {
  constructor(canvas, labels) {
    this.canvas = canvas;
    this.labels = labels;
    this.azimuth = Math.PI;
    this.elevation = 0.5;
    this.distance = null;
    this.target = [0, 0, 0];
    this.points = new Float32Array();
    this.boxes = [];
    this.gl = canvas.getContext("webgl", { preserveDrawingBuffer: true });
    if (!this.gl) return;
    this.pointProgram = this.program(POINT_SHADER);
    this.lineProgram = this.program(LINE_SHADER);
    this.pointBuffer = this.gl.createBuffer();
    this.lineBuffer = this.gl.createBuffer();
    let last = null;
    canvas.addEventListener("pointerdown", (event) => { last = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", () => { last = null; });
    canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      const [x, y] = [event.clientX - last[0], event.clientY - last[1]];
      last = [event.clientX, event.clientY];
      if (event.shiftKey || event.buttons & 2) this.pan(x, y);
      else { this.azimuth -= x * 0.006; this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation + y * 0.006)); }
      this.draw();
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.distance *= Math.exp(event.deltaY * 0.001); this.draw(); }, { passive: false });
  }

  program(vertex) {
    const { gl } = this, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "point");
    gl.linkProgram(program);
    return program;
  }

  pan(x, y) {
    const scale = this.distance * 0.0015, [sin, cos] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target[0] += (x * sin - y * cos) * scale;
    this.target[1] += (-x * cos - y * sin) * scale;
  }

  show(points, boxes) {
    this.points = points;
    this.boxes = boxes;
    if (this.distance === null && points.length > 0) this.look();
    this.draw();
  }

  /** Looks from behind and above at the middle of the points. */
  look() {
    const column = (axis) => Float32Array.from({ length: this.points.length / 4 }, (_, at) => this.points[4 * at + axis]).sort();
    const [x, y, z] = [column(0), column(1), column(2)], at = (values, share) => values[Math.floor((values.length - 1) * share)];
    this.heights = [at(z, 0.02), at(z, 0.98)];
    this.target = [at(x, 0.5), at(y, 0.5), at(z, 0.5)];
    this.distance = Math.max(at(x, 0.9) - at(x, 0.1), at(y, 0.9) - at(y, 0.1), 1) * 1.1;
  }

  matrix(aspect) {
    const [sa, ca, se, ce] = [Math.sin(this.azimuth), Math.cos(this.azimuth), Math.sin(this.elevation), Math.cos(this.elevation)];
    const back = [ca * ce, sa * ce, se], right = [-sa, ca, 0], up = [-ca * se, -sa * se, ce];
    const eye = this.target.map((value, axis) => value + back[axis] * this.distance);
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const rows = [right, up, back].map((axis) => [...axis, -dot(axis, eye)]);
    const focal = 1.6, [near, far] = [this.distance * 0.01, this.distance * 20];
    const depth = [(near + far) / (near - far), (2 * near * far) / (near - far)];
    const out = [
      rows[0].map((value) => (value * focal) / aspect),
      rows[1].map((value) => value * focal),
      rows[2].map((value, at) => value * depth[0] + (at === 3 ? depth[1] : 0)),
      rows[2].map((value) => -value),
    ];
    return new Float32Array([0, 1, 2, 3].flatMap((column) => out.map((row) => row[column])));
  }

  draw() {
    const { gl, canvas } = this;
    if (!gl || this.distance === null) return;
    const ratio = window.devicePixelRatio || 1, { clientWidth, clientHeight } = canvas;
    const size = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0.04, 0.055, 0.075, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const view = this.matrix(clientWidth / Math.max(clientHeight, 1));
    const lines = new Float32Array(this.boxes.flatMap((box) => EDGES.flatMap((corner) => [...box.corners[corner], 1])));
    const batches = [[this.pointProgram, this.pointBuffer, this.points, gl.POINTS], [this.lineProgram, this.lineBuffer, lines, gl.LINES]];
    for (const [program, buffer, data, mode] of batches) {
      gl.useProgram(program);
      gl.uniformMatrix4fv(gl.getUniformLocation(program, "view"), false, view);
      if (mode === gl.POINTS) {
        gl.uniform2fv(gl.getUniformLocation(program, "heights"), this.heights);
        gl.uniform1f(gl.getUniformLocation(program, "size"), 1.5 * ratio);
      }
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
      gl.drawArrays(mode, 0, data.length / 4);
    }
    this.write(view);
  }

  /** Writes the names of the boxes beside them. */
  write(view) {
    const { context, width, height } = prepared(this.labels);
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = "#ffb0b0";
    for (const { corners, name } of this.boxes) {
      const [x, y, z] = corners[4];
      const [a, b, , w] = [0, 1, 2, 3].map((row) => view[row] * x + view[4 + row] * y + view[8 + row] * z + view[12 + row]);
      if (w > 0) context.fillText(name, ((a / w + 1) * width) / 2, ((1 - b / w) * height) / 2 - 4);
    }
  }
}
