// One stage for all images of a page: what is shown, from where, and how brightly.

/** An image to show: { name, key, label, pixels, flip?, isReference? }, `pixels` and `flip` from codec.js. */
class Viewer {
  constructor(root, width, height) {
    Object.assign(this, { root, parts: partsOf(root), images: [], listeners: [], pointer: null });
    this.view = new View(width, height);
    this.state = { image: 0, split: null, divider: 0.5, stops: 0, tone: "srgb", mode: "image" };
    this.painter = this.choosePainter(Math.max(width, height));
    this.painter.canvas.setAttribute("aria-hidden", "true");
    this.parts.stage.prepend(this.painter.canvas);
    this.parts.stage.style.setProperty("--ratio", width / height);
    new ResizeObserver(() => this.measure()).observe(this.parts.stage);
  }

  choosePainter(largest) {
    try {
      const painter = new GlPainter(largest);
      painter.onrestored = () => this.redraw();
      return painter;
    } catch {
      return new CpuPainter();
    }
  }

  /** Shows the images, number `first` before the others; to be called once they are unpacked. */
  open(images, first) {
    this.images = images;
    this.reference = images.find((image) => image.isReference);
    this.state.image = first;
    fillControls(this);
    listenToControls(this);
    listenToKeys(this);
    const { stage, divider } = this.parts;
    new Gestures(stage, this.view, {
      changed: () => this.changed(),
      pointed: (place) => {
        this.pointer = place;
        this.read();
      },
    });
    listenToDivider(divider, stage, () => this.state.divider, (at) => this.set({ divider: at }));
    this.parts.wait.remove();
    this.measure();
    this.changed();
  }

  /** Which kinds of picture there are. */
  modes() {
    return MODES.filter((mode) =>
      mode === "image" || (mode === "relative" && this.reference) || this.images.some((image) => image[mode]));
  }

  /** The kind that the current image really has. */
  shownMode(index = this.state.image) {
    const { mode } = this.state;
    const image = this.images[index];
    if (mode === "flip") return image.flip ? mode : "image";
    return mode === "relative" && this.reference && !image.isReference ? mode : "image";
  }

  /** What the split view starts with: the reference, or the next image. */
  partner() {
    const other = this.images.findIndex((image, index) => image.isReference && index !== this.state.image);
    if (other >= 0) return other;
    return this.images.length > 1 ? (this.state.image + 1) % this.images.length : null;
  }

  /** Shows the image with that number key. */
  pick(key) {
    const index = this.images.findIndex((image) => image.key === key);
    if (index >= 0) this.set({ image: index });
  }

  set(changes) {
    Object.assign(this.state, changes);
    this.state.stops = Math.min(Math.max(Math.round(10 * this.state.stops) / 10, -10), 10);
    this.changed();
  }

  move(how) {
    how(this.view);
    this.changed();
  }

  changed() {
    showState(this);
    this.read();
    this.redraw();
    for (const listener of this.listeners) listener(this);
  }

  fill() {
    if (document.fullscreenElement) document.exitFullscreen();
    else if (this.root.requestFullscreen) this.root.requestFullscreen();
    else this.root.classList.toggle("filled");
  }

  measure() {
    const { width, height } = this.parts.stage.getBoundingClientRect();
    this.view.resize(width, height);
    const ratio = window.devicePixelRatio || 1;
    const size = [Math.max(Math.round(width * ratio), 1), Math.max(Math.round(height * ratio), 1)];
    const { canvas } = this.painter;
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    if (this.images.length) this.redraw(true);
  }

  /** What to paint of an image, in columns `from` to `to`. */
  layer(index, from = 0, to = 0) {
    const { pixels, flip } = this.images[index];
    const { stops, tone } = this.state;
    const reference = this.reference?.pixels;
    return { image: pixels, flip, reference, mode: this.shownMode(index), gain: 2 ** stops, tone, from, to };
  }

  /** Paints before the next frame; at once where a resize has just emptied the canvas. */
  redraw(now = false) {
    if (now) return this.draw();
    if (!this.frame) this.frame = requestAnimationFrame(() => this.draw());
  }

  draw() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    const { canvas } = this.painter;
    const { image, split, divider } = this.state;
    const edge = split === null ? canvas.width : Math.round(divider * canvas.width);
    const layers = [this.layer(image, 0, edge)];
    if (split !== null) layers.push(this.layer(split, edge, canvas.width));
    const ratio = canvas.width / this.view.stage.width;
    this.painter.paint(layers, this.view, ratio);
  }

  /** The image pixel under the pointer, or null. */
  target() {
    if (!this.pointer) return null;
    const [x, y] = this.view.at(this.pointer.x, this.pointer.y).map(Math.floor);
    const { width, height } = this.view;
    return x >= 0 && y >= 0 && x < width && y < height ? { x, y } : null;
  }

  /** Writes down the values under the pointer. */
  read() {
    if (!this.images.length) return;
    const target = this.target();
    const zoom = make("span", { class: "zoom" }, `${Math.round(100 * this.view.scale)} %`);
    if (!target) {
      const hint = make("span", { class: "quiet" }, "Point at the image to read its values.");
      return this.parts.readout.replaceChildren(hint, zoom);
    }
    const { divider, split, image } = this.state;
    const isRight = split !== null && this.pointer.x > divider * this.view.stage.width;
    const shown = this.images[isRight ? split : image];
    const place = make("span", { class: "place" }, `${target.x}, ${target.y}`);
    const cells = [place, valueCell(shown.name, shown.pixels, target)];
    const { reference } = this;
    if (reference && reference !== shown) cells.push(valueCell("reference", reference.pixels, target));
    if (shown.flip) {
      const [error] = pixelAt(shown.flip, target.x, target.y);
      cells.push(make("span", {}, make("i", {}, "FLIP"), short(error)));
    }
    this.parts.readout.replaceChildren(...cells, zoom);
  }
}

/** A name and the three linear values of a pixel. */
function valueCell(name, pixels, { x, y }) {
  const write = (value) => (Number.isNaN(value) ? "NaN" : short(value));
  const values = pixelAt(pixels, x, y).map((value, c) => make("b", { class: "rgb"[c] }, write(value)));
  return make("span", {}, make("i", {}, name), ...values);
}
