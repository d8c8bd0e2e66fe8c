// What is done when the page opens. `caustica` is for the console and for tests.

async function start() {
  listenToTheme();
  listenToHelp();
  if (typeof DecompressionStream === "undefined")
    return showTrouble("This browser is too old to unpack the images. A current Chrome, Edge, Firefox or Safari can.");
  const data = JSON.parse(document.getElementById("data").textContent);
  try {
    const open = data.verification ? openVerification : data.strategies ? openPyramid : openComparison;
    const parts = await open(data);
    window.caustica = { data, ...parts };
  } catch (error) {
    showTrouble(`This page could not be shown: ${error.message}`);
    throw error;
  }
}

start();
