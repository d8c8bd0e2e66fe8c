// The page that compares images.

/** Unpacks the images: the reference first, then the entries in the order of their keys. */
async function comparedImages({ reference, entries }) {
  const images = [];
  const read = ({ width, height }, id) => unpackRgb(id, width, height);
  if (reference) {
    const pixels = await read(reference, "reference");
    images.push({ name: reference.name || "reference", key: "0", isReference: true, pixels });
  }
  for (const [i, { shown, label }] of entries.entries()) {
    const hasFlip = document.getElementById(`flip-${i}`) !== null;
    images.push({
      name: shown.name,
      key: i < 9 ? String(i + 1) : "",
      label,
      pixels: await read(shown, `image-${i}`),
      flip: hasFlip ? await unpackUnit(`flip-${i}`, shown.width, shown.height) : null,
    });
  }
  return images;
}

async function openComparison(data) {
  const { entries, insets, reference } = data;
  if (entries.some((entry) => entry.curve.length)) new Curves(document.getElementById("curves"), entries);
  const root = document.getElementById("viewer");
  const first = reference || entries[0]?.shown;
  const viewer = first && new Viewer(root, first.width, first.height);
  const offset = reference ? 1 : 0;
  const show = (index) => {
    viewer.set({ image: index + offset });
    root.scrollIntoView({ block: "start", behavior: "smooth" });
  };
  if (entries.length) fillTable(document.getElementById("metrics"), entries, show);
  if (!viewer) return null;
  // Whoever compares puts the best last.
  const images = await comparedImages(data);
  viewer.open(images, images.length - 1);
  if (insets.length) new Insets(document.getElementById("insets"), viewer, insets);
  keepAddress(viewer);
  return { viewer };
}
