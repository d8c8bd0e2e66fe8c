// Undoes what src/encode.rs does: base64, zlib, prediction.

/** The value of each of the 65536 halves. */
const HALVES = Float32Array.from({ length: 65536 }, (_, bits) => {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const rest = bits & 1023;
  if (exponent === 31) return rest ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + rest / 1024) : 2 ** -24 * rest);
});

const BYTES = Float32Array.from({ length: 256 }, (_, byte) => byte / 255);

/** The unzipped bytes of a block of the page. The block goes: its text would keep the memory. */
async function unzip(id) {
  const block = document.getElementById(id);
  const text = atob(block.textContent);
  block.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Plane number `index` of `bytes`: high bytes, low bytes, signs folded, predicted from left and above. */
function plane(bytes, index, width, height) {
  const count = width * height;
  const high = 2 * index * count;
  const values = new Int16Array(count);
  for (let i = 0, y = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i++) {
      const folded = (bytes[high + i] << 8) | bytes[high + count + i];
      let predicted = 0;
      if (x && y) predicted = (values[i - 1] + values[i - width]) >> 1;
      else if (x) predicted = values[i - 1];
      else if (y) predicted = values[i - width];
      values[i] = predicted + ((folded >> 1) ^ -(folded & 1));
    }
  }
  return values;
}

/** An image of three halves a pixel. `table` turns what is in `data` into numbers. */
async function unpackRgb(id, width, height) {
  const bytes = await unzip(id);
  const [green, red, blue] = [0, 1, 2].map((index) => plane(bytes, index, width, height));
  const data = new Uint16Array(3 * width * height);
  for (let i = 0, k = 0; i < green.length; i++, k += 3) {
    data[k] = red[i] + green[i];
    data[k + 1] = green[i];
    data[k + 2] = blue[i] + green[i];
  }
  return { width, height, channels: 3, data, table: HALVES, version: 0 };
}

/** An error map: one byte a pixel. */
async function unpackUnit(id, width, height) {
  const data = Uint8Array.from(plane(await unzip(id), 0, width, height));
  return { width, height, channels: 1, data, table: BYTES, version: 0 };
}

/** An image of floats, to be filled and refilled; whoever fills it counts `version` up. */
function floatImage(width, height) {
  return { width, height, channels: 3, data: new Float32Array(3 * width * height), table: null, version: 0 };
}

/** The channels of a pixel. */
function pixelAt(image, x, y) {
  const at = (y * image.width + x) * image.channels;
  const raw = image.data.subarray(at, at + image.channels);
  return Array.from(raw, (value) => (image.table ? image.table[value] : value));
}
