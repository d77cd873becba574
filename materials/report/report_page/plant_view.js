// The plant in WebGL 2: one buffer for all, one texel of colour a domain, picking by drawing ids.
"use strict";

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in uint domain;
uniform mat4 camera;
uniform vec3 origin;
uniform float step_;
uniform highp sampler2D colours;
out vec3 at, outward;
out vec4 colour;
flat out uint id;
void main() {
  at = origin + step_ * position;
  outward = normal;
  id = domain;
  colour = texelFetch(colours, ivec2(int(domain & 255u), int(domain >> 8u)), 0);
  gl_Position = camera * vec4(at, 1);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, outward;
in vec4 colour;
flat in uint id;
uniform vec3 eye, faded;
uniform uint chosen;
uniform int mode;  // 0 shaded, 1 ids, 2 the chosen one through what hides it
uniform vec3 chosen_colour;
out vec4 pixel;
void main() {
  if (mode == 1) {
    pixel = vec4(float(id & 255u), float((id >> 8u) & 255u), float((id >> 16u) & 255u), 255.0) / 255.0;
    return;
  }
  vec3 to_eye = normalize(eye - at);
  vec3 n = length(outward) > 0.1 ? normalize(outward) : to_eye;
  if (dot(n, to_eye) < 0.0) n = -n;  // leaves have two sides
  float light = 0.42 + 0.2 * (0.5 + 0.5 * n.y) + 0.28 * max(dot(n, normalize(vec3(0.5, 0.8, 0.35))), 0.0) + 0.14 * dot(n, to_eye);
  vec3 shaded = colour.rgb * min(light, 1.08);
  if (chosen != 0u && id != chosen) shaded = mix(shaded, faded, 0.55);
  if (mode == 2) pixel = vec4(mix(colour.rgb, chosen_colour, 0.75) * light, 0.8);
  else pixel = vec4(shaded, 1);
}`;

const LINE_VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
uniform mat4 camera;
void main() { gl_Position = camera * vec4(position, 1); }`;
const LINE_FRAGMENT = `#version 300 es
precision highp float;
uniform vec4 colour;
out vec4 pixel;
void main() { pixel = colour; }`;

class PlantView {
  constructor(canvas, mesh) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!this.gl) throw new Error("this browser has no WebGL 2: the plant cannot be shown");
    this.chosen = -1;
    this.onPick = this.onHover = () => {};
    this.program = this.link(VERTEX, FRAGMENT);
    this.lines = this.link(LINE_VERTEX, LINE_FRAGMENT);
    this.load(mesh);
    this.texture = this.gl.createTexture();
    this.home();
    this.listen();
    new ResizeObserver(() => this.request()).observe(canvas);
  }

  link(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const places = {};
    return { program, at: (name) => (places[name] ??= gl.getUniformLocation(program, name)) };
  }

  /** Buffers of 16 bytes a vertex: position, normal, id + 1. Keeps which indices a domain has. */
  load(mesh) {
    const gl = this.gl, places = new Uint16Array(bytesOf(mesh.positions));
    const packed = mesh.index_bytes === 4 ? new Uint32Array(bytesOf(mesh.triangles)) : new Uint16Array(bytesOf(mesh.triangles));
    const vertices = places.length / 3;
    let count = 0;
    for (const [, , shape] of mesh.pieces) count += 3 * mesh.shapes[shape][1];
    const buffer = new ArrayBuffer(16 * vertices), u16 = new Uint16Array(buffer), i8 = new Int8Array(buffer), u32 = new Uint32Array(buffer);
    const indices = new Uint32Array(count), normals = new Float32Array(3 * vertices);
    this.ranges = new Map();
    let first = 0, next = 0;
    for (const [id, size, shape] of mesh.pieces) {
      const begin = next, [from, number] = mesh.shapes[shape];
      for (let k = 3 * from; k < 3 * (from + number); ++k) indices[next++] = first + packed[k];
      for (let t = begin; t < next; t += 3) this.addNormal(normals, places, indices, t);
      for (let v = first; v < first + size; ++v) {
        for (let k = 0; k < 3; ++k) u16[8 * v + k] = places[3 * v + k];
        const length = Math.hypot(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]) || 1;
        for (let k = 0; k < 3; ++k) i8[16 * v + 8 + k] = Math.round((127 * normals[3 * v + k]) / length);
        u32[4 * v + 3] = id + 1;
      }
      if (!this.ranges.has(id)) this.ranges.set(id, []);
      this.ranges.get(id).push([begin, next - begin, first, size]);
      first += size;
    }
    this.places = places;
    this.mesh = mesh;
    this.triangles = count / 3;
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, buffer, gl.STATIC_DRAW);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, false, 16, 0);
    gl.vertexAttribPointer(1, 3, gl.BYTE, true, 16, 8);
    gl.vertexAttribIPointer(2, 1, gl.UNSIGNED_INT, 16, 12);
    for (const i of [0, 1, 2]) gl.enableVertexAttribArray(i);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    this.box = this.bounds([...this.ranges.keys()]);
    this.makeGrid();
  }

  addNormal(normals, p, indices, t) {
    const [a, b, c] = [indices[t] * 3, indices[t + 1] * 3, indices[t + 2] * 3];
    const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
    const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (const v of [a, b, c]) (normals[v] += nx), (normals[v + 1] += ny), (normals[v + 2] += nz);
  }

  /** [least, most], m, of some domains. */
  bounds(ids) {
    const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity], { origin, step } = this.mesh;
    for (const id of ids)
      for (const [, , first, size] of this.ranges.get(id) ?? [])
        for (let v = first; v < first + size; ++v)
          for (let k = 0; k < 3; ++k) {
            const x = origin[k] + step * this.places[3 * v + k];
            least[k] = Math.min(least[k], x);
            most[k] = Math.max(most[k], x);
          }
    return [least, most];
  }

  makeGrid() {
    const gl = this.gl, [least, most] = this.box, middle = [0, 1, 2].map((k) => (least[k] + most[k]) / 2);
    const reach = 0.75 * Math.max(most[0] - least[0], most[2] - least[2], 0.4 * (most[1] - least[1]));
    this.gridStep = ticks(0, reach, false, 6)[1] || reach;
    const points = [], n = Math.ceil(reach / this.gridStep);
    for (let i = -n; i <= n; ++i) {
      const half = Math.sqrt(Math.max(n * n - i * i, 0)) * this.gridStep, d = i * this.gridStep;
      points.push(middle[0] + d, least[1], middle[2] - half, middle[0] + d, least[1], middle[2] + half);
      points.push(middle[0] - half, least[1], middle[2] + d, middle[0] + half, least[1], middle[2] + d);
    }
    this.grid = gl.createVertexArray();
    this.gridCount = points.length / 3;
    gl.bindVertexArray(this.grid);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STATIC_DRAW);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
    gl.enableVertexAttribArray(0);
  }

  /** colours: [r, g, b] of every domain; what was left out is red. */
  setColours(colours) {
    const gl = this.gl, rows = Math.ceil((colours.length + 1) / 256), texels = new Uint8Array(1024 * rows);
    texels.set([200, 40, 60, 255]);
    colours.forEach((c, id) => texels.set([c[0], c[1], c[2], 255], 4 * (id + 1)));
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    this.request();
  }

  home() {
    this.yaw = 0.6;
    this.pitch = 0.16;
    this.frame(this.box, 0.84);
  }

  frame([least, most], margin) {
    this.target = least.map((x, k) => (x + most[k]) / 2);
    const radius = Math.hypot(...least.map((x, k) => most[k] - x)) / 2;
    this.distance = Math.max((margin * radius) / Math.sin(0.5 * this.fov()), 1e-3);
    this.request();
  }

  fov() {
    const aspect = this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1);
    return aspect < 1 ? 0.7 * Math.max(aspect, 0.3) : 0.7;
  }

  eye() {
    const c = Math.cos(this.pitch);
    return [c * Math.sin(this.yaw), Math.sin(this.pitch), c * Math.cos(this.yaw)].map((d, k) => this.target[k] + d * this.distance);
  }

  axes() {
    const c = Math.cos(this.pitch), s = Math.sin(this.pitch), cy = Math.cos(this.yaw), sy = Math.sin(this.yaw);
    return [[cy, 0, -sy], [-s * sy, c, -s * cy], [c * sy, s, c * cy]];
  }

  camera() {
    const [x, y, z] = this.axes(), e = this.eye(), dot = (a) => -(a[0] * e[0] + a[1] * e[1] + a[2] * e[2]);
    const view = [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, dot(x), dot(y), dot(z), 1];
    const f = 1 / Math.tan(this.fov() / 2), aspect = this.canvas.width / this.canvas.height;
    const size = Math.hypot(...this.box[0].map((v, k) => this.box[1][k] - v));
    const near = Math.max(this.distance - 1.5 * size, this.distance * 0.01), far = this.distance + 2 * size;
    const p = [f / aspect, f, (far + near) / (near - far), (2 * far * near) / (near - far)];
    const m = new Float32Array(16);
    for (let c = 0; c < 4; ++c) {
      const v = view.slice(4 * c, 4 * c + 4);
      m.set([p[0] * v[0], p[1] * v[1], p[2] * v[2] + p[3] * v[3], -v[2]], 4 * c);
    }
    return m;
  }

  request() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  resize() {
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(Math.round(this.canvas.clientWidth * scale), 1), height = Math.max(Math.round(this.canvas.clientHeight * scale), 1);
    if (this.canvas.width !== width || this.canvas.height !== height) (this.canvas.width = width), (this.canvas.height = height);
  }

  draw() {
    const gl = this.gl;
    this.resize();
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.drawPlant(0);
    const line = rgb(cssColour("--quiet"));
    gl.useProgram(this.lines.program);
    gl.uniformMatrix4fv(this.lines.at("camera"), false, this.camera());
    gl.uniform4f(this.lines.at("colour"), line[0] / 255, line[1] / 255, line[2] / 255, 0.3);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.bindVertexArray(this.grid);
    gl.drawArrays(gl.LINES, 0, this.gridCount);
    if (this.chosen >= 0) this.drawChosen();
    gl.disable(gl.BLEND);
  }

  drawPlant(mode) {
    const gl = this.gl, at = this.program.at;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.program.program);
    gl.uniformMatrix4fv(at("camera"), false, this.camera());
    gl.uniform3fv(at("origin"), this.mesh.origin);
    gl.uniform1f(at("step_"), this.mesh.step);
    gl.uniform3fv(at("eye"), this.eye());
    gl.uniform3fv(at("faded"), rgb(cssColour("--stage-b")).map((c) => c / 255));
    gl.uniform3fv(at("chosen_colour"), rgb(cssColour("--chosen")).map((c) => c / 255));
    gl.uniform1ui(at("chosen"), this.chosen + 1);
    gl.uniform1i(at("mode"), mode);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.bindVertexArray(this.array);
    gl.drawElements(gl.TRIANGLES, 3 * this.triangles, gl.UNSIGNED_INT, 0);
  }

  /** Once more, over everything: the chosen one shines through what hides it. */
  drawChosen() {
    const gl = this.gl;
    gl.useProgram(this.program.program);
    gl.uniform1i(this.program.at("mode"), 2);
    gl.bindVertexArray(this.array);
    gl.disable(gl.DEPTH_TEST);
    for (const [begin, count] of this.ranges.get(this.chosen) ?? []) gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * begin);
  }

  /** How many pixels are not background. */
  drawnPixels() {
    const gl = this.gl, { width, height } = this.canvas, pixels = new Uint8Array(4 * width * height);
    this.draw();
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let drawn = 0;
    for (let i = 3; i < pixels.length; i += 4) drawn += pixels[i] > 200;
    return drawn;
  }

  /** Ids + 1 of all pixels, rows from below. */
  drawIds() {
    const gl = this.gl;
    this.resize();
    const { width, height } = this.canvas;
    if (!this.ids) this.ids = { frame: gl.createFramebuffer(), colour: gl.createRenderbuffer(), depth: gl.createRenderbuffer() };
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.ids.frame);
    for (const [buffer, format, place] of [[this.ids.colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [this.ids.depth, gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
    this.drawPlant(1);
  }

  /** The domain at a point of the canvas (CSS pixels), or near it; -1 where there is none. */
  pick(x, y) {
    const gl = this.gl, scale = this.canvas.width / this.canvas.clientWidth, reach = 3;
    this.drawIds();
    const size = 2 * reach + 1, pixels = new Uint8Array(4 * size * size);
    gl.readPixels(Math.round(x * scale) - reach, Math.round(this.canvas.height - 1 - y * scale) - reach, size, size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.request();
    let best = -1, least = Infinity;
    for (let i = 0; i < size * size; ++i) {
      const distance = Math.hypot((i % size) - reach, Math.floor(i / size) - reach);
      if (pixels[4 * i + 3] && distance < least) (least = distance), (best = pixels[4 * i] + 256 * pixels[4 * i + 1] + 65536 * pixels[4 * i + 2] - 1);
    }
    return best;
  }

  /** A point of the canvas (CSS pixels) that shows the plant; null when none does. */
  somewhere() {
    const gl = this.gl;
    this.drawIds();
    const { width, height } = this.canvas, pixels = new Uint8Array(4 * width * height), shown = [];
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    for (let i = 0; i < width * height; ++i) if (pixels[4 * i + 3]) shown.push(i);
    if (!shown.length) return null;
    const i = shown[shown.length >> 1], scale = this.canvas.clientWidth / width;
    return [((i % width) + 0.5) * scale, (height - Math.floor(i / width) - 0.5) * scale];
  }

  choose(id) {
    this.chosen = id;
    this.request();
  }

  listen() {
    const canvas = this.canvas;
    let down = null, moved = 0;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      down = event;
      moved = 0;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!down) return this.onHover(event.offsetX, event.offsetY);
      const dx = event.movementX, dy = event.movementY;
      moved += Math.abs(dx) + Math.abs(dy);
      if (event.shiftKey || down.button) {
        const [x, y] = this.axes(), metres = (2 * this.distance * Math.tan(this.fov() / 2)) / canvas.clientHeight;
        this.target = this.target.map((t, k) => t + metres * (dy * y[k] - dx * x[k]));
      } else {
        this.yaw -= 0.008 * dx;
        this.pitch = Math.min(Math.max(this.pitch + 0.008 * dy, -1.55), 1.55);
      }
      this.request();
    });
    canvas.addEventListener("pointerup", (event) => {
      if (down && moved < 5) this.onPick(this.pick(event.offsetX, event.offsetY));
      down = null;
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.distance *= Math.exp(0.0012 * Math.max(-300, Math.min(300, event.deltaY)));
      this.request();
    }, { passive: false });
    canvas.addEventListener("dblclick", () => this.chosen >= 0 && this.frame(this.bounds([this.chosen]), 1.6));
    canvas.addEventListener("keydown", (event) => event.key === "Home" && this.home());
  }
}
