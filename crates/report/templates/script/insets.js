// The same small parts of every image, side by side.

class Insets {
  constructor(section, viewer, insets) {
    Object.assign(this, { viewer, canvases: [] });
    const rows = insets.map((inset) => this.row(inset));
    section.querySelector(".rows").replaceChildren(...rows);
    section.hidden = false;
    viewer.listeners.push(() => this.later());
    this.paint();
  }

  row(inset) {
    const cells = this.viewer.images.map((image, index) => {
      const canvas = make("canvas", { "aria-hidden": "true" });
      this.canvases.push({ canvas, index, inset });
      const title = `${image.name}: ${inset.label}`;
      const button = make("button", { type: "button", class: "plain", title }, canvas, make("span", {}, image.name));
      button.style.setProperty("--ratio", inset.width / inset.height);
      button.addEventListener("click", () => this.go(inset, index));
      return button;
    });
    const place = `${inset.width} × ${inset.height} at ${inset.x}, ${inset.y}`;
    const heading = make("h3", {}, inset.label || place, " ");
    if (inset.label) heading.append(make("small", {}, place));
    return make("div", { class: "inset" }, heading, make("div", { class: "crops" }, ...cells));
  }

  go(inset, index) {
    this.viewer.view.frame(inset);
    this.viewer.set({ image: index });
    this.viewer.root.scrollIntoView({ block: "start", behavior: "smooth" });
  }

  later() {
    const { stops, tone, mode } = this.viewer.state;
    const now = `${stops} ${tone} ${mode}`;
    if (now === this.painted || this.frame) return;
    this.frame = requestAnimationFrame(() => this.paint());
  }

  paint() {
    this.frame = 0;
    const { stops, tone, mode } = this.viewer.state;
    this.painted = `${stops} ${tone} ${mode}`;
    for (const { canvas, index, inset } of this.canvases) paintCrop(canvas, this.viewer.layer(index), inset);
  }
}
