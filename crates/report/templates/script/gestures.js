// Mouse, fingers and wheel on the stage.

const DOUBLE_TAP_MS = 300;

/** Turns pointers on `stage` into moves of `view`. Calls `changed` after each, and `pointed` with places. */
function listenToGestures(stage, view, { changed, pointed }) {
  const fingers = new Map();
  let lastTap = { time: -Infinity, x: 0, y: 0 };
  let travelled = 0;
  let isTouch = false;
  const place = (event) => {
    const box = stage.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  const zoomInOrBack = ({ x, y }) => {
    if (view.scale > view.fitScale * 1.01) view.fit();
    else view.zoom(Math.max(4 / view.scale, 2), x, y);
    changed();
  };

  const pinch = (id, now) => {
    const [other] = [...fingers].filter(([key]) => key !== id).map(([, at]) => at);
    const before = fingers.get(id);
    const apart = (p) => Math.hypot(p.x - other.x, p.y - other.y);
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    view.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    view.zoom(apart(now) / Math.max(apart(before), 1), middle.x, middle.y);
  };

  const move = (event) => {
    const now = place(event);
    pointed(now);
    const before = fingers.get(event.pointerId);
    if (!before) return;
    travelled += Math.hypot(now.x - before.x, now.y - before.y);
    if (fingers.size === 2) pinch(event.pointerId, now);
    else view.pan(now.x - before.x, now.y - before.y);
    fingers.set(event.pointerId, now);
    changed();
  };

  const release = (event) => {
    if (!fingers.delete(event.pointerId) || event.type === "pointercancel") return;
    if (event.pointerType !== "touch" || travelled > 8) return;
    const { x, y } = place(event);
    const near = Math.hypot(x - lastTap.x, y - lastTap.y) < 30;
    if (near && event.timeStamp - lastTap.time < DOUBLE_TAP_MS) zoomInOrBack({ x, y });
    lastTap = { time: event.timeStamp, x, y };
  };

  stage.addEventListener("pointerdown", (event) => {
    if (event.button > 0 || fingers.size > 1 || event.target.closest("button, .divider")) return;
    stage.setPointerCapture(event.pointerId);
    if (!fingers.size) travelled = 0;
    isTouch = event.pointerType === "touch";
    fingers.set(event.pointerId, place(event));
    pointed(place(event));
  });
  stage.addEventListener("pointermove", move);
  stage.addEventListener("pointerup", release);
  stage.addEventListener("pointercancel", release);
  stage.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && pointed(null));
  // Some browsers send this after two taps as well, which `release` has answered already.
  stage.addEventListener("dblclick", (event) => isTouch || zoomInOrBack(place(event)));
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    // Touchpads send pinches as small turns of the wheel with Ctrl.
    const lines = event.deltaMode ? 16 : event.ctrlKey ? 4 : 1;
    const { x, y } = place(event);
    view.zoom(2 ** (-Math.max(Math.min(event.deltaY * lines, 200), -200) / 200), x, y);
    changed();
  }, { passive: false });
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
