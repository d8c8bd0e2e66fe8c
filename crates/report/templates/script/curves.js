// Error against time or samples, both logarithmic, as SVG.

const svg = (tag, attributes = {}, ...children) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
};

const ACROSS = { seconds: ["Time", "seconds"], samples: ["Samples", "samples per pixel"] };
const ERRORS = { rel_mse: ["relMSE", "relMSE"], trimmed_rel_mse: ["Trimmed", "relMSE without the worst 0.1 %"] };

/** The points of a curve that a logarithmic plot can show, in order. */
function pointsOf(entry, across, error) {
  const points = entry.curve.map((point) => [point[across], point[error]]);
  return points.filter(([x, y]) => x > 0 && y > 0 && x < Infinity && y < Infinity).sort((a, b) => a[0] - b[0]);
}

/** The error at x between a curve's points, by a straight line in the logarithms; NaN outside. */
function errorAt(points, x) {
  const after = points.findIndex(([px]) => px >= x);
  if (after < 0 || (after === 0 && points[0][0] > x)) return NaN;
  if (after === 0) return points[0][1];
  const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
  return y0 * (y1 / y0) ** (Math.log(x / x0) / Math.log(x1 / x0));
}

class Curves {
  constructor(section, entries) {
    this.plot = section.querySelector(".plot");
    this.entries = entries;
    this.choice = { across: "seconds", error: "rel_mse" };
    this.off = new Set();
    const parts = partsOf(section);
    this.offer(parts.across, "across", ACROSS);
    this.offer(parts.error, "error", ERRORS);
    this.legend(section.querySelector(".legend"));
    section.hidden = false;
    new ResizeObserver(() => this.draw()).observe(this.plot);
    this.plot.addEventListener("pointermove", (event) => this.hover(event));
    this.plot.addEventListener("pointerdown", (event) => this.hover(event));
    this.plot.addEventListener("pointerleave", () => this.unhover());
  }

  offer(group, choice, texts) {
    const buttons = Object.entries(texts).map(([name, [text]]) => {
      const button = make("button", { type: "button", "aria-pressed": this.choice[choice] === name }, text);
      button.addEventListener("click", () => {
        this.choice[choice] = name;
        for (const other of buttons) other.setAttribute("aria-pressed", other === button);
        this.draw();
      });
      return button;
    });
    group.replaceChildren(...buttons);
  }

  legend(list) {
    const items = this.entries.map((entry, index) => {
      const line = make("i", { class: "dash", style: `--ink: var(--ink-${index % 8})` });
      const { name } = entry.shown;
      const button = make("button", { type: "button", class: "plain", "aria-pressed": true }, line, name);
      if (Number.isFinite(entry.slope ?? NaN)) button.append(make("small", {}, `slope ${signed(entry.slope, 2)}`));
      button.addEventListener("click", () => {
        if (!this.off.delete(index)) this.off.add(index);
        button.setAttribute("aria-pressed", !this.off.has(index));
        this.draw();
      });
      return entry.curve.length ? button : "";
    });
    list.replaceChildren(...items);
  }

  draw() {
    const { across, error } = this.choice;
    const width = Math.max(this.plot.clientWidth, 200);
    const height = Math.round(Math.min(Math.max(width * 0.5, 260), 420));
    this.lines = this.entries.map((entry) => pointsOf(entry, across, error));
    const seen = this.lines.flatMap((points, index) => (this.off.has(index) ? [] : points));
    if (!seen.length) return this.plot.replaceChildren(make("p", { class: "quiet" }, "Nothing to show."));
    this.box = { left: 58, right: width - 14, top: 12, bottom: height - 42 };
    this.x = logAxis(seen.map(([x]) => x), this.box.left, this.box.right);
    this.y = logAxis(seen.map(([, y]) => y), this.box.bottom, this.box.top);
    const title = `${ERRORS[error][1]} against ${ACROSS[across][1]}`;
    const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": title });
    picture.append(...this.grid(height), ...this.curves());
    this.rule = svg("g", { class: "rule" });
    this.tip = make("div", { class: "tip", hidden: "" });
    picture.append(this.rule);
    this.plot.replaceChildren(picture, this.tip);
  }

  grid(height) {
    const { left, right, top, bottom } = this.box;
    const text = (x, y, anchor, label) => svg("text", { x, y, "text-anchor": anchor }, label);
    const lines = [];
    for (const [value, label] of this.x.ticks) {
      const x = this.x.at(value);
      lines.push(svg("line", { x1: x, x2: x, y1: top, y2: bottom, class: label ? "major" : "minor" }));
      if (label) lines.push(text(x, bottom + 17, "middle", label));
    }
    for (const [value, label] of this.y.ticks) {
      const y = this.y.at(value);
      lines.push(svg("line", { x1: left, x2: right, y1: y, y2: y, class: label ? "major" : "minor" }));
      if (label) lines.push(text(left - 8, y + 4, "end", label));
    }
    const across = text((left + right) / 2, height - 6, "middle", ACROSS[this.choice.across][1]);
    across.setAttribute("class", "title");
    return [...lines, across];
  }

  curves() {
    return this.lines.map((points, index) => {
      const group = svg("g", { class: "curve", style: `--ink: var(--ink-${index % 8})` });
      if (this.off.has(index) || !points.length) return group;
      const places = points.map(([x, y]) => [this.x.at(x), this.y.at(y)]);
      group.append(svg("polyline", { points: places.map((place) => place.map((v) => v.toFixed(1)).join()).join(" ") }));
      group.append(...places.map(([cx, cy]) => svg("circle", { cx, cy, r: 2.6 })));
      return group;
    });
  }

  unhover() {
    if (!this.tip) return;
    this.tip.hidden = true;
    this.rule.replaceChildren();
  }

  /** Every curve's error at the pointer's time, the least first. */
  hover(event) {
    if (!this.tip?.isConnected) return;
    const pixel = event.clientX - this.plot.getBoundingClientRect().left;
    const { left, right, top, bottom } = this.box;
    if (pixel < left || pixel > right) return this.unhover();
    const x = this.x.back(pixel);
    const found = this.lines
      .map((points, index) => ({ index, error: this.off.has(index) ? NaN : errorAt(points, x) }))
      .filter(({ error }) => Number.isFinite(error))
      .sort((a, b) => a.error - b.error);
    if (!found.length) return this.unhover();
    this.rule.replaceChildren(
      svg("line", { x1: pixel, x2: pixel, y1: top, y2: bottom }),
      ...found.map(({ index, error }) =>
        svg("circle", { cx: pixel, cy: this.y.at(error), r: 4, style: `--ink: var(--ink-${index % 8})` })),
    );
    const unit = this.choice.across === "seconds" ? duration(x) : `${short(x)} samples`;
    const rows = found.map(({ index, error }) => {
      const dash = make("i", { class: "dash", style: `--ink: var(--ink-${index % 8})` });
      return make("div", {}, dash, make("span", {}, this.entries[index].shown.name), make("b", {}, short(error)));
    });
    this.tip.replaceChildren(make("strong", {}, unit), ...rows);
    this.tip.hidden = false;
    const isRight = pixel > (left + right) / 2;
    this.tip.style.left = isRight ? "" : `${pixel + 14}px`;
    this.tip.style.right = isRight ? `${this.plot.clientWidth - pixel + 14}px` : "";
  }
}
