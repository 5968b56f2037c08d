// What WebGL draws: the surfaces, points, and lines of any width.

const SURFACE = [`#version 300 es
uniform mat4 toClip;
in vec3 position; in vec3 colour;
out vec3 place; out vec3 tint;
void main() { place = position; tint = colour; gl_Position = toClip * vec4(position, 1); }`,
`#version 300 es
precision highp float;
uniform vec3 eye, lower, upper; uniform float cut, opacity; uniform bool glows;
in vec3 place; in vec3 tint;
out vec4 result;
void main() {
  vec3 d = eye - place;
  if (length(d) < cut) discard;
  // Walls that the scene ends with are left out where one looks from outside.
  vec3 rim = 0.012 * (upper - lower) + 1e-6;
  if (any(lessThan(eye, lower)) && any(equal(vec3(1), vec3(lessThan(place, lower + rim)) * vec3(lessThan(eye, lower))))) discard;
  if (any(greaterThan(eye, upper)) && any(equal(vec3(1), vec3(greaterThan(place, upper - rim)) * vec3(greaterThan(eye, upper))))) discard;
  vec3 n = normalize(cross(dFdx(place), dFdy(place)));
  float light = glows ? 1.15 : 0.42 + 0.5 * abs(dot(n, normalize(d))) + 0.08 * n.y;
  result = vec4(tint * light, opacity);
}`];

const POINTS = [`#version 300 es
uniform mat4 toClip; uniform vec3 eye; uniform float size, pixelsPerRadian, lift;
in vec3 position; in vec3 colour; in float radius; in vec3 side;
out vec3 tint; flat out float ring;
void main() {
  vec3 towards = eye - position;
  // Off the surface, on the side that light came from: walls without thickness hide what lies on their other side.
  gl_Position = toClip * vec4(position + (side == vec3(0) ? towards * 0.002 : side * lift), 1);
  ring = radius;
  gl_PointSize = radius > 0.0 ? clamp(2.0 * radius * pixelsPerRadian / length(towards), 3.0, 200.0) : size;
  tint = colour;
}`,
`#version 300 es
precision highp float;
uniform float opacity;
in vec3 tint; flat in float ring;
out vec4 result;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  if (r > 1.0 || (ring > 0.0 && r < 0.84 && r > 0.16)) discard;
  result = vec4(tint, ring > 0.0 ? 0.8 : opacity);
}`];

const LINES = [`#version 300 es
uniform mat4 toClip; uniform vec2 screen; uniform vec3 eye;
in vec2 corner; in vec3 from, to, tint; in float width;
out vec4 colour;
uniform float opacity;
void main() {
  // A little nearer than it is, so that it doesn't sink into the surfaces that it ends on.
  vec4 a = toClip * vec4(mix(from, eye, 0.002), 1), b = toClip * vec4(mix(to, eye, 0.002), 1);
  float near = 1e-4;
  if (a.w < near && b.w < near) { gl_Position = vec4(2, 2, 2, 1); return; }
  if (a.w < near) a = mix(b, a, (b.w - near) / (b.w - a.w));
  if (b.w < near) b = mix(a, b, (a.w - near) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * screen;
  vec2 across = length(along) > 1e-6 ? normalize(vec2(-along.y, along.x)) : vec2(0, 1);
  gl_Position = corner.x < 0.5 ? a : b;
  gl_Position.xy += across * corner.y * width / screen * gl_Position.w;
  colour = vec4(tint, opacity);
}`,
`#version 300 es
precision highp float;
in vec4 colour;
out vec4 result;
void main() { result = colour; }`];

class Program {
  constructor(gl, [vertex, fragment], attributes) {
    this.gl = gl;
    this.program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(this.program, shader);
    }
    attributes.forEach((name, i) => gl.bindAttribLocation(this.program, i, name));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(this.program));
  }
  use(uniforms) {
    const gl = this.gl;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(uniforms)) {
      const at = gl.getUniformLocation(this.program, name);
      if (typeof value === "boolean") gl.uniform1i(at, value ? 1 : 0);
      else if (typeof value === "number") gl.uniform1f(at, value);
      else if (value.length === 2) gl.uniform2fv(at, value);
      else if (value.length === 3) gl.uniform3fv(at, value);
      else gl.uniformMatrix4fv(at, false, value);
    }
  }
}

// Attributes in buffers: [index, array, numbers each, instanced].
function vertexArray(gl, buffers, indices) {
  const vao = gl.createVertexArray();
  gl.bindVertexArray(vao);
  for (const [at, array, each, instanced] of buffers) {
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(at);
    const type = array instanceof Uint8Array ? gl.UNSIGNED_BYTE : array instanceof Int8Array ? gl.BYTE : gl.FLOAT;
    gl.vertexAttribPointer(at, each, type, type !== gl.FLOAT, 0, 0);
    if (instanced) gl.vertexAttribDivisor(at, 1);
  }
  if (indices) {
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
  }
  gl.bindVertexArray(null);
  return vao;
}
