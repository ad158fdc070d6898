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
  const fit = (scale) => {
    for (const id of Object.keys(report.charts)) {
      const node = document.getElementById(id);
      Plotly.relayout(node, scale ? { width: node.clientWidth, height: node.clientHeight } : { autosize: true, width: null, height: null });
    }
  };
  addEventListener("beforeprint", () => fit(true));
  addEventListener("afterprint", () => fit(false));
  Promise.all(drawn).then(() => { document.body.dataset.ready = "yes"; });
})();
