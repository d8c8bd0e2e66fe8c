// Painting on a 2D canvas: thumbnails, insets, and the stage where there is no WebGL.

/** The ranges of image pixels that lie under `count` canvas pixels, as [from, to) pairs. */
function ranges(count, centre, scale, size) {
  const pairs = new Int32Array(2 * count);
  for (let i = 0; i < count; i++) {
    const left = centre + (i - count / 2) / scale;
    const right = left + 1 / scale;
    const from = scale >= 1 ? Math.floor((left + right) / 2) : Math.round(left);
    pairs[2 * i] = Math.max(from, 0);
    pairs[2 * i + 1] = Math.min(scale >= 1 ? from + 1 : Math.max(Math.round(right), from + 1), size);
  }
  return pairs;
}

/** The mean of a block of pixels, all channels. */
function blockMean(image, [x0, x1], [y0, y1]) {
  const { data, table, channels, width } = image;
  const sum = [0, 0, 0];
  for (let y = y0; y < y1; y++)
    for (let x = x0; x < x1; x++)
      for (let c = 0, k = (y * width + x) * channels; c < channels; c++, k++)
        sum[c] += table ? table[data[k]] : data[k];
  const count = (x1 - x0) * (y1 - y0);
  return sum.map((s) => s / count);
}

/** Display bytes of a block of a layer's image. */
function shadeBlock(layer, xs, ys) {
  const { image, reference, flip, mode, gain, tone } = layer;
  if (mode === "flip" && flip) return MAGMA_TABLE[Math.round(255 * blockMean(flip, xs, ys)[0])];
  const rgb = blockMean(image, xs, ys);
  if (mode === "relative" && reference) {
    const error = relativeError(rgb, blockMean(reference, xs, ys), floorOf(reference));
    if (!Number.isFinite(error)) return [255, 0, 255];
    return SIGNED_TABLE[Math.round(127.5 * (1 + Math.min(Math.max(error, -1), 1)))];
  }
  return develop(rgb, gain, tone);
}

/** Paints columns `from` to `to` of a canvas; `view` is in canvas pixels: { x, y, scale }. */
function paintBlocks(canvas, layer, view, [from, to]) {
  const context = canvas.getContext("2d");
  const picture = context.createImageData(Math.max(to - from, 1), canvas.height);
  const columns = ranges(canvas.width, view.x, view.scale, layer.image.width);
  const rows = ranges(canvas.height, view.y, view.scale, layer.image.height);
  for (let j = 0, k = 0; j < canvas.height; j++) {
    const ys = [rows[2 * j], rows[2 * j + 1]];
    for (let i = from; i < to; i++, k += 4) {
      const xs = [columns[2 * i], columns[2 * i + 1]];
      if (xs[0] >= xs[1] || ys[0] >= ys[1]) continue;
      picture.data.set(shadeBlock(layer, xs, ys), k);
      picture.data[k + 3] = 255;
    }
  }
  context.putImageData(picture, from, 0);
}

/** Fills a canvas with a rectangle of the image, pixel by pixel. */
function paintCrop(canvas, layer, { x, y, width, height }) {
  canvas.width = width;
  canvas.height = height;
  paintBlocks(canvas, layer, { x: x + width / 2, y: y + height / 2, scale: 1 }, [0, width]);
}

/** A smaller copy of linear light, `width` pixels wide. */
function shrink(image, width) {
  const scale = Math.min(width / image.width, 1);
  const small = floatImage(Math.round(image.width * scale) || 1, Math.round(image.height * scale) || 1);
  const columns = ranges(small.width, image.width / 2, scale, image.width);
  const rows = ranges(small.height, image.height / 2, scale, image.height);
  for (let y = 0, k = 0; y < small.height; y++)
    for (let x = 0; x < small.width; x++, k += 3) {
      const [xs, ys] = [columns.subarray(2 * x, 2 * x + 2), rows.subarray(2 * y, 2 * y + 2)];
      small.data.set(blockMean(image, xs, ys), k);
    }
  return small;
}

class CpuPainter {
  constructor() {
    this.canvas = document.createElement("canvas");
  }

  paint(layers, view, ratio) {
    const scaled = { x: view.x, y: view.y, scale: view.scale * ratio };
    for (const layer of layers)
      if (layer.to > layer.from) paintBlocks(this.canvas, layer, scaled, [layer.from, layer.to]);
  }
}
