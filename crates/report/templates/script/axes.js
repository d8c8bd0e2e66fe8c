// Logarithmic axes.

const SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹";

const power = (exponent) =>
  `10${exponent < 0 ? "⁻" : ""}${[...String(Math.abs(exponent))].map((digit) => SUPERSCRIPTS[digit]).join("")}`;

/** A map from values to pixels, and back, for `values` between pixels `from` and `to`. */
function logAxis(values, from, to) {
  let [low, high] = [Math.log10(Math.min(...values)), Math.log10(Math.max(...values))];
  const air = Math.max(0.04 * (high - low), 0.05);
  [low, high] = [low - air, high + air];
  const at = (value) => from + ((Math.log10(value) - low) / (high - low)) * (to - from);
  const back = (pixel) => 10 ** (low + ((pixel - from) / (to - from)) * (high - low));
  return { at, back, ticks: ticks(low, high) };
}

/** Powers of ten, and what lies between them where these are few: [value, label or ""]. */
function ticks(low, high) {
  const span = high - low;
  const labelled = span < 0.9 ? [1, 2, 3, 5, 7] : span < 2.2 ? [1, 2, 5] : [1];
  const stride = Math.max(1, Math.ceil(span / 7));
  const list = [];
  for (let exponent = Math.floor(low); exponent <= high; exponent++)
    for (let digit = 1; digit < 10; digit++) {
      const value = digit * 10 ** exponent;
      if (value < 10 ** low || value > 10 ** high) continue;
      if (digit > 1 && span > 5) continue;
      const hasLabel = labelled.includes(digit) && exponent % stride === 0;
      list.push([value, hasLabel ? tickLabel(digit, exponent) : ""]);
    }
  return list;
}

function tickLabel(digit, exponent) {
  if (exponent >= -2 && exponent <= 3) return String(Number((digit * 10 ** exponent).toPrecision(3)));
  return digit === 1 ? power(exponent) : `${digit}·${power(exponent)}`;
}
