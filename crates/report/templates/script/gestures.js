// Mouse, fingers and wheel on the stage.

const DOUBLE_TAP_MS = 300;

/** Turns pointers on `stage` into moves of `view`. Calls `changed` after each, and `pointed` with places. */
class Gestures {
  constructor(stage, view, { changed, pointed }) {
    Object.assign(this, { stage, view, changed, pointed });
    this.fingers = new Map();
    this.lastTap = { time: -Infinity, x: 0, y: 0 };
    this.travelled = 0;
    this.isTouch = false;
    stage.addEventListener("pointerdown", (event) => this.press(event));
    stage.addEventListener("pointermove", (event) => this.move(event));
    stage.addEventListener("pointerup", (event) => this.release(event));
    stage.addEventListener("pointercancel", (event) => this.fingers.delete(event.pointerId));
    stage.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && pointed(null));
    // Some browsers send this after two taps as well, which `release` has answered already.
    stage.addEventListener("dblclick", (event) => this.isTouch || this.zoomInOrBack(this.place(event)));
    stage.addEventListener("wheel", (event) => this.turn(event), { passive: false });
  }

  place(event) {
    const box = this.stage.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  zoomInOrBack({ x, y }) {
    const { view } = this;
    if (view.scale > view.fitScale * 1.01) view.fit();
    else view.zoom(Math.max(4 / view.scale, 2), x, y);
    this.changed();
  }

  press(event) {
    const { fingers } = this;
    if (event.button > 0 || fingers.size > 1 || event.target.closest("button, .divider")) return;
    this.stage.setPointerCapture(event.pointerId);
    if (!fingers.size) this.travelled = 0;
    this.isTouch = event.pointerType === "touch";
    fingers.set(event.pointerId, this.place(event));
    this.pointed(this.place(event));
  }

  move(event) {
    const now = this.place(event);
    this.pointed(now);
    const before = this.fingers.get(event.pointerId);
    if (!before) return;
    this.travelled += Math.hypot(now.x - before.x, now.y - before.y);
    if (this.fingers.size === 2) this.pinch(event.pointerId, before, now);
    else this.view.pan(now.x - before.x, now.y - before.y);
    this.fingers.set(event.pointerId, now);
    this.changed();
  }

  pinch(id, before, now) {
    const [other] = [...this.fingers].filter(([key]) => key !== id).map(([, at]) => at);
    const apart = (p) => Math.hypot(p.x - other.x, p.y - other.y);
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    this.view.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    this.view.zoom(apart(now) / Math.max(apart(before), 1), middle.x, middle.y);
  }

  release(event) {
    this.fingers.delete(event.pointerId);
    if (event.pointerType !== "touch" || this.travelled > 8) return;
    const { x, y } = this.place(event);
    const near = Math.hypot(x - this.lastTap.x, y - this.lastTap.y) < 30;
    if (near && event.timeStamp - this.lastTap.time < DOUBLE_TAP_MS) this.zoomInOrBack({ x, y });
    this.lastTap = { time: event.timeStamp, x, y };
  }

  turn(event) {
    event.preventDefault();
    // Touchpads send pinches as small turns of the wheel with Ctrl.
    const lines = event.deltaMode ? 16 : event.ctrlKey ? 4 : 1;
    const { x, y } = this.place(event);
    this.view.zoom(2 ** (-Math.max(Math.min(event.deltaY * lines, 200), -200) / 200), x, y);
    this.changed();
  }
}

/** Lets the divider be dragged and moved by keys; `move` gets its place in [0, 1]. */
function listenToDivider(divider, stage, current, move) {
  let held = null;
  const follow = (event) => {
    if (event.pointerId !== held) return;
    const box = stage.getBoundingClientRect();
    move(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1));
  };
  divider.addEventListener("pointerdown", (event) => {
    event.stopPropagation();
    event.preventDefault();
    held = event.pointerId;
    divider.setPointerCapture(held);
    divider.focus({ preventScroll: true });
  });
  divider.addEventListener("pointermove", follow);
  for (const end of ["pointerup", "pointercancel"]) divider.addEventListener(end, () => (held = null));
  divider.addEventListener("dblclick", (event) => event.stopPropagation());
  divider.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    move(Math.min(Math.max(current() + step, 0), 1));
  });
}
