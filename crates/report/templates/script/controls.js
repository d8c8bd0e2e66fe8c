// Buttons, sliders, menus and keys of the viewer.

const make = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
};

/** The elements inside `root` that the scripts fill, by their data-part. */
const partsOf = (root) =>
  Object.fromEntries([...root.querySelectorAll("[data-part]")].map((part) => [part.dataset.part, part]));

const signed = (number, digits = 1) =>
  `${number < 0 ? "−" : "+"}${Math.abs(number).toFixed(digits)}`;

/** Four digits, as short as they go. */
function short(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (value !== 0 && (size < 1e-3 || size >= 1e5)) {
    const [digits, exponent] = value.toExponential(2).split("e");
    return `${digits}·${power(Number(exponent))}`;
  }
  return size >= 1000 ? value.toFixed(0) : value.toPrecision(4);
}

const next = (list, current) => list[(list.indexOf(current) + 1) % list.length];

/** What each key does to a viewer. */
const KEYS = {
  "+": (v) => v.move((view) => view.zoom(2)),
  "=": (v) => v.move((view) => view.zoom(2)),
  "-": (v) => v.move((view) => view.zoom(0.5)),
  ArrowLeft: (v) => v.move((view) => view.pan(60, 0)),
  ArrowRight: (v) => v.move((view) => view.pan(-60, 0)),
  ArrowUp: (v) => v.move((view) => view.pan(0, 60)),
  ArrowDown: (v) => v.move((view) => view.pan(0, -60)),
  h: (v) => v.move((view) => view.fit()),
  o: (v) => v.move((view) => view.show(view.x, view.y, 1)),
  f: (v) => v.fill(),
  e: (v) => v.set({ stops: v.state.stops + 0.5 }),
  E: (v) => v.set({ stops: v.state.stops - 0.5 }),
  t: (v) => v.set({ tone: next(TONES, v.state.tone) }),
  m: (v) => v.set({ mode: next(v.modes(), v.state.mode) }),
  s: (v) => v.set({ split: v.state.split === null ? v.partner() : null }),
  r: (v) => v.pick("0"),
};

/** Keys work wherever the focus is, but where they mean something else there. */
function listenToKeys(viewer) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const inForm = event.target.closest?.("input, select, textarea");
    const onStage = viewer.parts.stage.contains(event.target) || event.target === document.body;
    if (inForm && (inForm.tagName !== "INPUT" || event.key.startsWith("Arrow"))) return;
    if (event.key.startsWith("Arrow") && !onStage) return;
    if (event.key.startsWith("Arrow") && event.target === document.body && viewer.view.fitted) return;
    if (/^[0-9]$/.test(event.key)) viewer.pick(event.key);
    else {
      const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
      if (!act) return;
      act(viewer);
    }
    event.preventDefault();
  });
}

function listenToControls(viewer) {
  const { root, parts } = viewer;
  const acts = { in: "+", out: "-", fit: "h", one: "o", full: "f" };
  for (const button of root.querySelectorAll("[data-act]"))
    button.addEventListener("click", () => KEYS[acts[button.dataset.act]](viewer));
  parts.exposure.addEventListener("input", () => viewer.set({ stops: Number(parts.exposure.value) }));
  parts.exposure.addEventListener("dblclick", () => viewer.set({ stops: 0 }));
  parts.tone.addEventListener("change", () => viewer.set({ tone: parts.tone.value }));
  parts.mode.addEventListener("change", () => viewer.set({ mode: parts.mode.value }));
  parts.split.addEventListener("change", () =>
    viewer.set({ split: parts.split.value === "" ? null : Number(parts.split.value) }));
}

/** Makes the buttons and menus that depend on which images there are. */
function fillControls(viewer) {
  const { parts, images } = viewer;
  parts.pick.replaceChildren(...images.map((image, index) => {
    const title = image.label || image.name;
    const button = make("button", { type: "button", title }, make("kbd", {}, image.key), image.name);
    button.addEventListener("click", () => viewer.set({ image: index }));
    return button;
  }));
  const choices = images.map((image, index) => make("option", { value: index }, image.name));
  parts.split.replaceChildren(make("option", { value: "" }, "nothing"), ...choices);
  parts["split-label"].hidden = images.length < 2;
  const modes = viewer.modes();
  for (const option of parts.mode.options) option.hidden = option.disabled = !modes.includes(option.value);
  parts["mode-label"].hidden = modes.length < 2;
}

/** Shows the viewer's state in its controls. */
function showState(viewer) {
  const { parts, state, images, view } = viewer;
  [...parts.pick.children].forEach((button, index) => button.setAttribute("aria-pressed", index === state.image));
  keepInSight(parts.pick, parts.pick.children[state.image]);
  parts.exposure.value = state.stops;
  parts.stops.textContent = state.stops ? signed(state.stops) : "0";
  parts.tone.value = state.tone;
  parts.mode.value = state.mode;
  parts.split.value = state.split ?? "";
  const isSplit = state.split !== null;
  parts.divider.hidden = parts["tag-right"].hidden = !isSplit;
  parts.divider.style.left = `${100 * state.divider}%`;
  parts.divider.setAttribute("aria-valuenow", Math.round(100 * state.divider));
  parts["tag-left"].textContent = images[state.image].name;
  parts["tag-right"].textContent = isSplit ? images[state.split].name : "";
  parts.stage.style.touchAction = view.fitted || view.scale <= view.fitScale * 1.001 ? "pan-y" : "none";
  showScale(parts.scale, viewer.shownMode());
}

/** Scrolls a bar, and nothing else, so far that a child of it is seen. */
function keepInSight(bar, child) {
  const [whole, part] = [bar.getBoundingClientRect(), child.getBoundingClientRect()];
  if (part.right > whole.right) bar.scrollLeft += part.right - whole.right + 4;
  else if (part.left < whole.left) bar.scrollLeft += part.left - whole.left - 4;
}

/** The legend of the error colours. */
function showScale(scale, mode) {
  scale.hidden = mode === "image";
  if (scale.hidden) return;
  const [bar, ...labels] = scale.children;
  bar.style.background = cssRamp(mode === "flip" ? MAGMA : SIGNED);
  const texts = mode === "flip" ? ["0", "FLIP", "1"] : ["−100 %", "error", "+100 %"];
  labels.forEach((label, i) => (label.textContent = texts[i]));
}
