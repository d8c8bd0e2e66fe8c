// What both pages have around the viewer: theme, help, troubles and the address.

function listenToTheme() {
  const root = document.documentElement;
  const isDark = () =>
    (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  // Some browsers refuse storage to files.
  try {
    root.dataset.theme = localStorage.getItem("caustica-theme") || "";
  } catch {
    root.dataset.theme = "";
  }
  document.getElementById("theme").addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    try {
      localStorage.setItem("caustica-theme", root.dataset.theme);
    } catch {
      return;
    }
  });
}

function listenToHelp() {
  const help = document.getElementById("help");
  const open = () => help.open || help.showModal();
  document.getElementById("help-open").addEventListener("click", open);
  help.addEventListener("click", (event) => event.target === help && help.close());
  document.addEventListener("keydown", (event) => {
    if (event.key === "?" && !event.target.closest?.("textarea")) open();
  });
}

function showTrouble(text) {
  const trouble = document.getElementById("trouble");
  trouble.textContent = text;
  trouble.hidden = false;
}

/** The viewer's state as the part of the address after #. */
function addressOf({ state, view, images }) {
  const words = new URLSearchParams({ image: images[state.image].name });
  if (!view.fitted) {
    words.set("zoom", view.scale.toPrecision(4));
    words.set("at", `${view.x.toFixed(1)},${view.y.toFixed(1)}`);
  }
  if (state.stops) words.set("stops", state.stops);
  if (state.tone !== "srgb") words.set("tone", state.tone);
  if (state.mode !== "image") words.set("show", state.mode);
  if (state.split !== null) {
    words.set("split", images[state.split].name);
    words.set("divider", state.divider.toFixed(3));
  }
  return `#${words}`;
}

/** Brings a viewer where an address says; what it says wrongly is passed over. */
function goTo(viewer, address) {
  const words = new URLSearchParams(address.slice(1));
  const number = (name) => (words.has(name) && words.get(name) !== "" ? Number(words.get(name)) : NaN);
  const index = (name) => viewer.images.findIndex((image) => image.name === words.get(name));
  const changes = { split: index("split") < 0 ? null : index("split") };
  if (index("image") >= 0) changes.image = index("image");
  changes.stops = Number.isFinite(number("stops")) ? number("stops") : 0;
  if (number("divider") >= 0 && number("divider") <= 1) changes.divider = number("divider");
  changes.tone = TONES.includes(words.get("tone")) ? words.get("tone") : "srgb";
  changes.mode = viewer.modes().includes(words.get("show")) ? words.get("show") : "image";
  const [x, y] = (words.get("at") || "").split(",").map(Number);
  const zoom = number("zoom");
  if (zoom > 0 && zoom <= LARGEST && Number.isFinite(x) && Number.isFinite(y)) viewer.view.show(x, y, zoom);
  else viewer.view.fit();
  viewer.set(changes);
}

function keepAddress(viewer) {
  if (location.hash.length > 1) goTo(viewer, location.hash);
  let timer = 0;
  const write = () => {
    clearTimeout(timer);
    // Browsers count changes of the address and refuse too many.
    timer = setTimeout(() => history.replaceState(null, "", addressOf(viewer)), 250);
  };
  viewer.listeners.push(write);
  addEventListener("hashchange", () => location.hash.length > 1 && goTo(viewer, location.hash));
}
