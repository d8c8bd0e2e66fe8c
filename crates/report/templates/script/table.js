// The table of errors: one row per image, sortable, the best values marked.

const duration = (seconds) => {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 120) return `${seconds < 10 ? seconds.toFixed(2) : seconds.toFixed(1)} s`;
  const [hours, minutes] = [Math.floor(seconds / 3600), Math.floor((seconds % 3600) / 60)];
  return hours ? `${hours} h ${minutes} min` : `${minutes} min ${Math.round(seconds % 60)} s`;
};

/** Heading, explanation, whether less (−1) or more (1) is better, and how it is written. */
const COLUMNS = {
  rel_mse: ["relMSE", "mean of squared relative errors", -1, short],
  trimmed_rel_mse: ["trimmed", "relMSE without the worst 0.1 % of pixels", -1, short],
  rmse: ["RMSE", "root of the mean squared error", -1, short],
  flip: ["FLIP", "mean HDR-FLIP, what an eye sees when flipping", -1, short],
  efficiency: ["efficiency", "1 / (relMSE · time)", 1, short],
  mean: ["mean", "Mean luminance: differs where an image is biased", 0, short],
  samples: ["samples", "samples per pixel", 0, (value) => (value === null ? "–" : String(Math.round(value)))],
  seconds: ["time", "time of rendering", 0, duration],
};

const numberOf = (entry, column) => entry.metrics[column] ?? NaN;

/** The columns in which any image has a number. */
const usedColumns = (entries) =>
  Object.keys(COLUMNS).filter((column) => entries.some((entry) => Number.isFinite(numberOf(entry, column))));

function bestOf(entries, column) {
  const better = COLUMNS[column][2];
  const values = entries.map((entry) => numberOf(entry, column)).filter(Number.isFinite);
  if (!better || values.length < 2) return null;
  return better < 0 ? Math.min(...values) : Math.max(...values);
}

function tableRow(entry, index, columns, best) {
  const button = make("button", { type: "button", class: "plain" }, entry.shown.name);
  const dot = make("i", { class: "dot", style: `--ink: var(--ink-${index % 8})` });
  const name = make("th", { scope: "row" }, dot, button);
  if (entry.label && entry.label !== entry.shown.name) name.append(make("small", {}, entry.label));
  const cells = columns.map((column) => {
    const value = numberOf(entry, column);
    const cell = make("td", {}, COLUMNS[column][3](Number.isFinite(value) ? value : null));
    if (value === best[column]) {
      cell.className = "best";
      cell.title = "the best";
    }
    return cell;
  });
  return { row: make("tr", {}, name, ...cells), button };
}

/** Fills the table; `show` is called with the number of an entry whose name is clicked. */
function fillTable(section, entries, show) {
  const columns = usedColumns(entries);
  const best = Object.fromEntries(columns.map((column) => [column, bestOf(entries, column)]));
  const rows = entries.map((entry, index) => {
    const { row, button } = tableRow(entry, index, columns, best);
    button.addEventListener("click", () => show(index));
    return row;
  });
  const body = section.querySelector("tbody");
  const headings = columns.map((column) => {
    const [text, title] = COLUMNS[column];
    return make("th", { scope: "col", title }, make("button", { type: "button", class: "plain" }, text));
  });
  headings.forEach((heading, at) => heading.firstChild.addEventListener("click", () => {
    const isUp = heading.getAttribute("aria-sort") === "ascending";
    for (const other of headings) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", isUp ? "descending" : "ascending");
    body.replaceChildren(...sorted(entries, columns[at], isUp ? -1 : 1).map((index) => rows[index]));
  }));
  section.querySelector("thead").replaceChildren(make("tr", {}, make("td"), ...headings));
  body.replaceChildren(...rows);
  section.hidden = false;
}

/** The entries' numbers in order; those without a value come last. */
function sorted(entries, column, sign) {
  const key = (index) => numberOf(entries[index], column);
  const compare = (a, b) => {
    const [x, y] = [key(a), key(b)];
    if (Number.isFinite(x) !== Number.isFinite(y)) return Number.isFinite(x) ? -1 : 1;
    return Number.isFinite(x) ? sign * (x - y) : 0;
  };
  return entries.map((_, index) => index).sort(compare);
}
