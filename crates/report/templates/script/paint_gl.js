// Painting with WebGL2. Each canvas pixel takes the mean of the image pixels under it: they stay sharp
// squares when large, and do not flicker when small.

const CORNERS = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

const floats = (list) => list.map((v) => v.toFixed(9)).join(", ");
const colourCode = (hex) => `vec3(${floats(channelsOf(hex).map((c) => c / 255))})`;
const rampCode = (stops) => `vec3[](${stops.map(colourCode).join(", ")})`;

const SHADE = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D image, reference, flip;
uniform vec2 size, centre, canvas;
uniform float scale, gain, black;
uniform int mode, tone;
out vec4 colour;

vec3 under(sampler2D source, vec2 low, vec2 high) {
  ivec2 first = ivec2(floor(low)), last = min(ivec2(ceil(high)) - 1, ivec2(size) - 1);
  ivec2 stride = max((last - first + 16) / 16, ivec2(1));
  vec4 sum = vec4(0.0);
  for (int y = first.y; y <= last.y; y += stride.y)
    for (int x = first.x; x <= last.x; x += stride.x) {
      vec2 inside = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
      sum += vec4(texelFetch(source, ivec2(x, y), 0).rgb, 1.0) * max(inside.x * inside.y, 1e-6);
    }
  return sum.rgb / sum.a;
}

vec3 agx(vec3 c) {
  c = transpose(mat3(${floats(AGX.inset)})) * c;
  c = clamp(log2(max(c, vec3(1e-10))), ${floats(AGX.range)});
  c = (c - (${floats([AGX.range[0]])})) / ${floats([AGX.range[1] - AGX.range[0]])};
  vec3 sum = vec3(0.0);
  float contrast[7] = float[](${floats(AGX.contrast)});
  for (int i = 0; i < 7; i++) sum = sum * c + contrast[i];
  return pow(max(transpose(mat3(${floats(AGX.outset)})) * sum, vec3(0.0)), vec3(2.2));
}

vec3 encode(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 magma(float at) {
  vec3 stops[${MAGMA.length}] = ${rampCode(MAGMA)};
  float place = clamp(at, 0.0, 1.0) * ${MAGMA.length - 1}.0;
  int low = min(int(place), ${MAGMA.length - 2});
  return mix(stops[low], stops[low + 1], place - float(low));
}

vec3 signedRamp(float at) {
  vec3 stops[${SIGNED.length}] = ${rampCode(SIGNED)};
  float place = clamp(at * 0.5 + 0.5, 0.0, 1.0) * ${SIGNED.length - 1}.0;
  int low = min(int(place), ${SIGNED.length - 2});
  return mix(stops[low], stops[low + 1], place - float(low));
}

void main() {
  vec2 place = vec2(gl_FragCoord.x, canvas.y - gl_FragCoord.y) - canvas * 0.5;
  vec2 at = centre + place / scale;
  vec2 low = max(at - 0.5 / scale, vec2(0.0)), high = min(at + 0.5 / scale, size);
  colour = vec4(0.0);
  if (any(lessThanEqual(high, low))) return;
  vec3 light = under(image, low, high);
  vec3 shown;
  if (mode == 1) {
    shown = magma(under(flip, low, high).r);
  } else if (any(isnan(light)) || any(isinf(light))) {
    shown = vec3(1.0, 0.0, 1.0);
  } else if (mode == 2) {
    vec3 weights = vec3(0.2126, 0.7152, 0.0722);
    float right = dot(under(reference, low, high), weights);
    shown = signedRamp((dot(light, weights) - right) / (right + black));
  } else {
    vec3 exposed = max(light * gain, vec3(0.0));
    shown = encode(tone == 1 ? agx(exposed) : exposed);
  }
  colour = vec4(shown, 1.0);
}`;

class GlPainter {
  /** Throws where there is no WebGL2 or where `largest` pixels do not fit in a texture. */
  constructor(largest) {
    this.canvas = document.createElement("canvas");
    const gl = this.canvas.getContext("webgl2", { antialias: false, depth: false });
    if (!gl || gl.getParameter(gl.MAX_TEXTURE_SIZE) < largest) throw new Error("no WebGL2 for this image");
    this.gl = gl;
    this.prepare();
    this.canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.prepare();
      this.onrestored?.();
    });
  }

  prepare() {
    const { gl } = this;
    this.textures = new WeakMap();
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, CORNERS], [gl.FRAGMENT_SHADER, SHADE]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || "no shader");
    gl.useProgram(program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.enable(gl.SCISSOR_TEST);
    this.place = (name) => gl.getUniformLocation(program, name);
    ["image", "reference", "flip"].forEach((name, unit) => gl.uniform1i(this.place(name), unit));
  }

  /** Binds the image's texture to a unit, and fills it if the image is new or has changed. */
  bind(unit, image) {
    const { gl } = this;
    let known = this.textures.get(image);
    gl.activeTexture(gl.TEXTURE0 + unit);
    if (!known) this.textures.set(image, (known = { texture: gl.createTexture(), version: -1 }));
    gl.bindTexture(gl.TEXTURE_2D, known.texture);
    if (known.version === image.version) return;
    const [inside, format, type] = this.format(image);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, inside, image.width, image.height, 0, format, type, image.data);
    known.version = image.version;
  }

  format({ table }) {
    const { gl } = this;
    if (table === HALVES) return [gl.RGB16F, gl.RGB, gl.HALF_FLOAT];
    if (table === BYTES) return [gl.R8, gl.RED, gl.UNSIGNED_BYTE];
    return [gl.RGB32F, gl.RGB, gl.FLOAT];
  }

  paint(layers, view, ratio) {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.uniform2f(this.place("canvas"), canvas.width, canvas.height);
    gl.uniform2f(this.place("centre"), view.x, view.y);
    gl.uniform1f(this.place("scale"), view.scale * ratio);
    for (const layer of layers) if (layer.to > layer.from) this.layer(layer);
  }

  layer({ image, reference, flip, mode, gain, tone, from, to }) {
    const { gl } = this;
    gl.scissor(from, 0, to - from, this.canvas.height);
    this.bind(0, image);
    this.bind(1, reference || image);
    this.bind(2, flip || image);
    const kind = (mode === "flip" && flip && 1) || (mode === "relative" && reference && 2) || 0;
    gl.uniform1i(this.place("mode"), kind);
    gl.uniform1i(this.place("tone"), TONES.indexOf(tone));
    gl.uniform1f(this.place("gain"), gain);
    gl.uniform1f(this.place("black"), reference ? floorOf(reference) : 1);
    gl.uniform2f(this.place("size"), image.width, image.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
