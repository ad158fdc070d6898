"use strict";
// Draws the charts that the page carries; nothing else moves.
(() => {
  const report = JSON.parse(document.getElementById("report-data").textContent);
  const isFinger = matchMedia("(pointer: coarse)").matches;
  const options = { responsive: true, displaylogo: false, plotlyServerURL: "", displayModeBar: false };
  const drawn = Object.entries(report.charts).map(([id, { data, layout }]) => {
    if (isFinger) layout.dragmode = false; // a finger that moves over a chart scrolls the page
    return Plotly.newPlot(document.getElementById(id), data, layout, options);
  });
  // On paper a chart has the size that the style gives its column there: two, of flights three, of influences one on a page of A4.
  const sizes = { worst: [215, 300], map: [330, 270], influences: [675, 220] };
  const onPaper = (id) => sizes[id.split("-")[0]] ?? [330, 220];
  addEventListener("beforeprint", () => {
    for (const id of Object.keys(report.charts)) {
      const [width, height] = onPaper(id);
      Plotly.relayout(document.getElementById(id), { width, height });
    }
  });
  addEventListener("afterprint", () => {
    for (const id of Object.keys(report.charts)) Plotly.relayout(document.getElementById(id), { width: null, height: null, autosize: true });
  });
  Promise.all(drawn).then(() => { document.body.dataset.ready = "yes"; });
})();
