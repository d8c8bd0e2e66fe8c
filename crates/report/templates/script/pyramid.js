// The page of strategies: a tier per path length, and their sum, made anew with every switch.

const THUMBNAIL = 176;
const nameOf = ({ s, t, longer }) => (longer ? "all longer paths" : `s = ${s}, t = ${t}`);
const lengthOf = ({ s, t, longer }) => (longer ? Infinity : s + t - 1);

class Pyramid {
  constructor(root, viewer, data) {
    Object.assign(this, { root, viewer, data, kind: "weighted", chosen: 0, work: Promise.resolve() });
    const { width, height } = data;
    if (data.longer) data.strategies.push({ longer: true });
    // Sums of halves are exact in doubles, so that nothing is left when a strategy is switched off again.
    this.total = new Float64Array(3 * width * height);
    this.sum = floatImage(width, height);
    this.on = data.strategies.map(() => true);
    this.sets = {};
    this.build();
  }

  /** The images and thumbnails of a kind, unpacked when they are first wanted. */
  async need(kind) {
    if (this.sets[kind]) return this.sets[kind];
    const { width, height, strategies } = this.data;
    const set = [];
    for (let i = 0; i < strategies.length; i++) {
      // Longer paths have no picture without weights. (The weighted ones come first.)
      if (strategies[i].longer && kind !== "weighted") {
        set.push(this.sets.weighted[i]);
        continue;
      }
      const pixels = await unpackRgb(`${kind}-${i}`, width, height);
      set.push({ pixels, small: shrink(pixels, THUMBNAIL * Math.min(devicePixelRatio || 1, 2)) });
    }
    return (this.sets[kind] = set);
  }

  build() {
    const lengths = [...new Set(this.data.strategies.map(lengthOf))].sort((a, b) => a - b);
    this.cells = [];
    const tiers = lengths.map((length) => this.tier(length));
    const widest = Math.max(...tiers.map((tier) => tier.lastChild.childElementCount));
    this.root.querySelector(".tiers").replaceChildren(...tiers);
    this.root.style.setProperty("--widest", widest);
    const scroller = this.root.querySelector(".tiers");
    scroller.scrollLeft = (scroller.scrollWidth - scroller.clientWidth) / 2;
    for (const button of this.root.querySelectorAll("[data-set]"))
      button.addEventListener("click", () => this.use(button.dataset.set));
    for (const button of this.root.querySelectorAll("[data-all]"))
      button.addEventListener("click", () => this.turn(() => true, button.dataset.all === "on"));
    this.lightButton = this.root.querySelector("[data-light]");
    const isLight = ({ t }) => t === 1;
    this.lightButton.hidden = !this.data.strategies.some(isLight);
    this.lightButton.addEventListener("click", () => this.turn(isLight, !this.isOn(isLight)));
  }

  tier(length) {
    const members = this.data.strategies
      .map((strategy, index) => ({ ...strategy, index }))
      .filter((strategy) => lengthOf(strategy) === length)
      .sort((a, b) => a.s - b.s);
    const isMember = (strategy) => lengthOf(strategy) === length;
    const edges = length === Infinity ? "longer" : `${length} edge${length === 1 ? "" : "s"}`;
    const title = length === Infinity ? "Switch all longer paths" : `Switch all paths of ${edges}`;
    const heading = make("button", { type: "button", class: "plain tier-name", "aria-pressed": true, title }, edges);
    heading.addEventListener("click", () => this.turn(isMember, !this.isOn(isMember)));
    const cells = members.map((strategy) => this.cell(strategy));
    const tier = make("div", { class: "tier" }, heading, make("div", { class: "cells" }, ...cells));
    tier.isMember = isMember;
    return tier;
  }

  cell(strategy) {
    const name = nameOf(strategy);
    const canvas = make("canvas", { "aria-hidden": "true" });
    const picture = make("button", { type: "button", class: "plain", title: `Show ${name} large` }, canvas);
    picture.style.setProperty("--ratio", this.data.width / this.data.height);
    picture.addEventListener("click", () => this.choose(strategy.index));
    const box = make("input", { type: "checkbox", "aria-label": name });
    box.checked = true;
    box.addEventListener("change", () => this.turn((_, index) => index === strategy.index, box.checked));
    const text = strategy.longer
      ? make("span", {}, "weighted")
      : make("span", {}, make("var", {}, "s"), ` = ${strategy.s}, `, make("var", {}, "t"), ` = ${strategy.t}`);
    const cell = make("div", { class: "cell" }, picture, make("label", {}, box, text));
    this.cells[strategy.index] = { cell, canvas, box };
    return cell;
  }

  isOn(which) {
    return this.data.strategies.every((strategy, index) => !which(strategy, index) || this.on[index]);
  }

  /** Switches strategies and changes the sum by them. */
  turn(which, on) {
    const set = this.sets[this.kind];
    // Still unpacking: nothing is changed, and what was clicked is put right when that is done.
    if (!set) return;
    this.data.strategies.forEach((strategy, index) => {
      if (!which(strategy, index) || this.on[index] === on) return;
      this.on[index] = on;
      this.add(set[index].pixels, on ? 1 : -1);
    });
    this.show();
  }

  /** Pixels that are not finite are left out: they could not be taken out again. */
  add({ data }, sign) {
    const { total } = this;
    for (let i = 0; i < data.length; i++) {
      const value = HALVES[data[i]];
      if (value - value === 0) total[i] += sign * value;
    }
  }

  /** Changes between weighted and unweighted. */
  use(kind) {
    this.work = this.work.then(async () => {
      const set = await this.need(kind);
      this.kind = kind;
      this.total.fill(0);
      set.forEach(({ pixels }, index) => this.on[index] && this.add(pixels, 1));
      this.choose(this.chosen, this.viewer.state?.image ?? 0);
    });
    return this.work;
  }

  /** Makes a strategy the viewer's second image. */
  choose(index, image = 1) {
    this.chosen = index;
    const strategy = this.data.strategies[index];
    const [sum, large] = this.images();
    Object.assign(large, { name: nameOf(strategy), pixels: this.sets[this.kind][index].pixels });
    sum.pixels = this.sum;
    if (this.viewer.images.length) {
      fillControls(this.viewer);
      this.viewer.state.image = image;
    }
    this.painted = null;
    this.show();
  }

  images() {
    this.shown ??= [
      { name: "sum", key: "1", label: "Sum of what is switched on" },
      { name: "", key: "2", label: "The chosen strategy" },
    ];
    return this.shown;
  }

  show() {
    this.sum.data.set(this.total);
    this.sum.version++;
    const count = this.on.filter(Boolean).length;
    partsOf(this.root).count.textContent = `${count} of ${this.on.length} strategies`;
    this.cells.forEach(({ cell, box }, index) => {
      box.checked = this.on[index];
      cell.classList.toggle("off", !this.on[index]);
      cell.classList.toggle("chosen", index === this.chosen);
    });
    for (const tier of this.root.querySelectorAll(".tier"))
      tier.firstChild.setAttribute("aria-pressed", this.isOn(tier.isMember));
    this.lightButton.setAttribute("aria-pressed", this.isOn(({ t }) => t === 1));
    for (const button of this.root.querySelectorAll("[data-set]"))
      button.setAttribute("aria-pressed", button.dataset.set === this.kind);
    if (this.viewer.images.length) this.viewer.changed();
    else this.paint();
  }

  /** Thumbnails follow exposure and tone map. */
  paint() {
    const { stops, tone } = this.viewer.state;
    const now = `${this.kind} ${stops} ${tone}`;
    if (now === this.painted) return;
    this.painted = now;
    this.cells.forEach(({ canvas }, index) => {
      const image = this.sets[this.kind][index].small;
      paintCrop(canvas, { image, mode: "image", gain: 2 ** stops, tone }, { x: 0, y: 0, ...sizeOf(image) });
    });
  }
}

const sizeOf = ({ width, height }) => ({ width, height });

async function openPyramid(data) {
  if (!data.strategies.length) return null;
  const viewer = new Viewer(document.getElementById("viewer"), data.width, data.height);
  const pyramid = new Pyramid(document.getElementById("pyramid"), viewer, data);
  await pyramid.use("weighted");
  let frame = 0;
  viewer.listeners.push(() => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      pyramid.paint();
    });
  });
  viewer.open(pyramid.images(), 0);
  const words = new URLSearchParams(location.hash.slice(1));
  const names = [words.get("image"), words.get("split")];
  const named = data.strategies.findIndex((strategy) => names.includes(nameOf(strategy)));
  if (named >= 0) pyramid.choose(named, 0);
  keepAddress(viewer);
  return { viewer, pyramid };
}
