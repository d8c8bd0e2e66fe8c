// The page that tells whether all ways to render a scene agree.

async function openVerification(data) {
  const { reference } = data;
  const viewer = new Viewer(document.getElementById("viewer"), reference.width, reference.height);
  viewer.open(await comparedImages(data), 0);
  keepAddress(viewer);
  const root = document.getElementById("viewer");
  for (const [i, button] of document.querySelectorAll("#estimators tbody button").entries())
    button.addEventListener("click", () => {
      viewer.set({ image: i + 1 });
      root.scrollIntoView({ block: "start", behavior: "smooth" });
    });
  return { viewer };
}
