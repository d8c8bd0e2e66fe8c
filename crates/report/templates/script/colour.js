// From linear light and errors to what a display shows. paint_gl.js has the same in GLSL.

const TONES = ["srgb", "agx"];
const MODES = ["image", "flip", "relative"];

/** Bytes of the sRGB transfer function (IEC 61966-2-1) for linear light in steps of 1/65535. */
const SRGB = Uint8Array.from({ length: 65536 }, (_, i) => {
  const linear = i / 65535;
  return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055) + 0.5;
});

/** Troy Sobotka's AgX with the constants that Benjamin Wrensch published; as in crates/film/src/tonemap.rs. */
const AGX = {
  inset: [
    0.84247906, 0.0784336, 0.079223745, 0.042328242, 0.87846864, 0.07916613, 0.042375654, 0.0784336, 0.879143,
  ],
  outset: [
    1.196879, -0.09802088, -0.09902974, -0.05289685, 1.1519031, -0.098961174, -0.052971635, -0.09804345, 1.1510737,
  ],
  range: [-12.47393, 4.026069],
  contrast: [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232],
};

/** Magma by Nathaniel Smith and Stéfan van der Walt (CC0), each tenth. */
const MAGMA = [
  0x000004, 0x140e36, 0x3b0f70, 0x641a80, 0x8c2981, 0xb73779, 0xde4968, 0xf7705c, 0xfe9f6d, 0xfecf92, 0xfcfdbf,
];
/** Too dark is blue, right is nearly black, too bright is orange. */
const SIGNED = [0xb8e2ff, 0x4aa3e8, 0x14518f, 0x141619, 0x9c4410, 0xf08a2c, 0xffe3a8];

const channelsOf = (hex) => [hex >> 16, (hex >> 8) & 255, hex & 255];

/** The colour at `at` in [0, 1], as bytes. */
function ramp(stops, at) {
  const place = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(place), stops.length - 2);
  const [a, b] = [channelsOf(stops[low]), channelsOf(stops[low + 1])];
  return a.map((c, i) => Math.round(c + (b[i] - c) * (place - low)));
}

const MAGMA_TABLE = Array.from({ length: 256 }, (_, i) => ramp(MAGMA, i / 255));
const SIGNED_TABLE = Array.from({ length: 256 }, (_, i) => ramp(SIGNED, i / 255));

const cssRamp = (stops) =>
  `linear-gradient(90deg, ${stops.map((hex) => `#${hex.toString(16).padStart(6, "0")}`).join(", ")})`;

const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

function agx(rgb) {
  const mix = (m, c) => [0, 3, 6].map((i) => m[i] * c[0] + m[i + 1] * c[1] + m[i + 2] * c[2]);
  const [low, high] = AGX.range;
  const shaped = mix(AGX.inset, rgb).map((c) => {
    const stops = Math.min(Math.max(Math.log2(Math.max(c, 1e-10)), low), high);
    return AGX.contrast.reduce((sum, k) => (sum * (stops - low)) / (high - low) + k, 0);
  });
  return mix(AGX.outset, shaped).map((c) => Math.max(c, 0) ** 2.2);
}

/** Display bytes of linear light. */
function develop(rgb, gain, tone) {
  if (!rgb.every(Number.isFinite)) return [255, 0, 255];
  let exposed = rgb.map((c) => Math.max(c * gain, 0));
  if (tone === "agx") exposed = agx(exposed);
  return exposed.map((c) => SRGB[Math.round(Math.min(c, 1) * 65535)]);
}

/** How much brighter than the reference, in parts of it. `floor` keeps black from dividing. */
const relativeError = (rgb, reference, floor) =>
  (luminance(rgb) - luminance(reference)) / (luminance(reference) + floor);

/** A hundredth of the mean brightness: what `relativeError` needs as its floor. */
function floorOf(image) {
  if (image.floor === undefined) {
    let [sum, count] = [0, 0];
    for (let y = 0; y < image.height; y += 4)
      for (let x = 0; x < image.width; x += 4) {
        const value = luminance(pixelAt(image, x, y));
        if (Number.isFinite(value)) [sum, count] = [sum + value, count + 1];
      }
    image.floor = Math.max((0.01 * sum) / Math.max(count, 1), 1e-6);
  }
  return image.floor;
}
