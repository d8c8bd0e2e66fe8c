// Which part of the images is seen. One view serves all images, so that they stay in step.

const LARGEST = 64;

/** The place (x, y), in image pixels, that is in the stage's middle, and page pixels per image pixel. */
class View {
  constructor(width, height) {
    Object.assign(this, { width, height, x: width / 2, y: height / 2, scale: 1 });
    this.stage = { width: 1, height: 1 };
    this.fitted = true;
  }

  get fitScale() {
    return Math.min(this.stage.width / this.width, this.stage.height / this.height);
  }

  resize(width, height) {
    this.stage = { width: Math.max(width, 1), height: Math.max(height, 1) };
    if (this.fitted) this.fit();
  }

  fit() {
    Object.assign(this, { x: this.width / 2, y: this.height / 2, scale: this.fitScale, fitted: true });
  }

  /** Image pixels at a place of the stage. */
  at(px, py) {
    return [
      this.x + (px - this.stage.width / 2) / this.scale,
      this.y + (py - this.stage.height / 2) / this.scale,
    ];
  }

  /** Moves by page pixels. */
  pan(dx, dy) {
    this.show(this.x - dx / this.scale, this.y - dy / this.scale, this.scale);
  }

  /** Zooms and leaves what is at (px, py) of the stage in its place. */
  zoom(factor, px = this.stage.width / 2, py = this.stage.height / 2) {
    const [x, y] = this.at(px, py);
    const smallest = Math.min(this.fitScale, 1) / 2;
    const scale = Math.min(Math.max(this.scale * factor, smallest), Math.max(LARGEST, this.fitScale));
    this.show(
      x - (px - this.stage.width / 2) / scale,
      y - (py - this.stage.height / 2) / scale,
      scale,
    );
  }

  show(x, y, scale) {
    const inside = (v, size) => Math.min(Math.max(v, 0), size);
    Object.assign(this, { x: inside(x, this.width), y: inside(y, this.height), scale, fitted: false });
  }

  /** Brings a rectangle of the image into the middle, with some of what is around. */
  frame({ x, y, width, height }) {
    const scale = 0.7 * Math.min(this.stage.width / width, this.stage.height / height);
    this.show(x + width / 2, y + height / 2, Math.min(scale, LARGEST));
  }
}
