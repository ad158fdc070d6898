// Plan and time series; Plotly draws.
const kinds = { f4: Float32Array, f8: Float64Array };
const decode = ({ dtype, bdata }) => new kinds[dtype](Uint8Array.from(atob(bdata), (c) => c.charCodeAt(0)).buffer);
const plain = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
const GRAY = "#8C8C8C";
const CALM = 400; // [ms] after the last move the axes are fitted again
const PANELS = [
  ["cross_track", "cross-track error [m]"],
  ["ahead", "ahead of the fleet's mean [m]"],
  ["lost_way", "position error [m]"],
  ["speed", "speed [m/s]"],
];

export const unpack = (flight) => ({
  ...flight,
  times: decode(flight.times),
  lines: Object.fromEntries(Object.entries(flight.lines).map(([name, columns]) => [name, columns.map(decode)])),
  reference: { north: decode(flight.reference.north), east: decode(flight.reference.east) },
  paths: flight.paths.map((line) => ({ north: decode(line.north), east: decode(line.east) })),
});

export const makeCharts = ({ plan, series, base }) => {
  const options = {
    responsive: true, displaylogo: false, scrollZoom: false, plotlyServerURL: "",
    modeBarButtonsToRemove: ["sendChartToCloud", "select2d", "lasso2d", "autoScale2d"],
    displayModeBar: window.innerWidth > 720 ? "hover" : false,
  };
  const isCoarse = matchMedia("(pointer: coarse)").matches;
  let shown = null, marker = 0, instant = null, waiting = false, settling = null;

  const line = (x, y, look, more = {}) => ({ type: "scatter", mode: "lines", x, y, line: look, hoverinfo: "skip", showlegend: false, ...more });
  const planTraces = (flight, pinned) => {
    const traces = [line(flight.reference.east, flight.reference.north, { color: GRAY, width: 1, dash: "dot" }, { name: "reference path" })];
    flight.paths.forEach((path, k) => traces.push(line(path.east, path.north, { color: flight.colors[k], width: 7 }, { opacity: 0.2 })));
    if (pinned) {
      pinned.vehicles.forEach((name, k) =>
        traces.push(line(pinned.lines.east[k], pinned.lines.north[k], { color: pinned.colors[k], width: 1.6, dash: "dash" },
          { opacity: 0.75, ...(k === 0 && { showlegend: true, name: "pinned (dashed)" }) })));
    }
    flight.vehicles.forEach((name, k) => {
      const text = plain(name);
      traces.push(line(flight.lines.east_estimate[k], flight.lines.north_estimate[k], { color: flight.colors[k], width: 1, dash: "dot" }));
      traces.push(line(flight.lines.east[k], flight.lines.north[k], { color: flight.colors[k], width: 1.8 },
        { name: text, showlegend: true, hoverinfo: "text", hovertemplate: `${text}<br>north %{y:.2f} m, east %{x:.2f} m<extra></extra>`, meta: "track" }));
    });
    return traces;
  };
  const vehicles = (flight) => {
    const times = flight.times;
    let at = times.length - 1;
    if (instant !== null) { at = times.findIndex((time) => time >= instant); if (at < 0) at = times.length - 1; }
    const value = (name) => flight.vehicles.map((_, k) => flight.lines[name][k][at]);
    return { x: value("east"), y: value("north"), angle: value("heading").map((angle) => (angle * 180) / Math.PI) };
  };
  const planLayout = (name) => ({
    ...base, uirevision: name, hovermode: "closest", dragmode: isCoarse ? false : "pan",
    xaxis: { title: { text: "east [m]" }, constrain: "domain" },
    yaxis: { title: { text: "north [m]" }, scaleanchor: "x", scaleratio: 1, constrain: "domain" },
    margin: { l: 52, r: 34, t: 4, b: 40 },
    modebar: { ...base.modebar, orientation: "v" }, // beside the plan, not over its legend
    legend: { orientation: "h", y: 1, yanchor: "bottom", x: 0 },
  });
  const seriesFigure = (flight, pinned) => {
    const panels = PANELS.filter(([name]) => name !== "ahead" || flight.vehicles.length > 1);
    const height = 1 / panels.length, traces = [], axes = {}, heads = [];
    panels.forEach(([name, title], row) => {
      const axis = row ? `y${row + 1}` : "y";
      const top = 1 - row * height;
      axes[`yaxis${row ? row + 1 : ""}`] = { domain: [top - height + 0.02, top - 0.055], zeroline: true, nticks: 5, automargin: false };
      heads.push({ text: title, x: 0, xref: "paper", xanchor: "left", y: top, yref: "paper", yanchor: "top", yshift: 3, showarrow: false, font: { size: 12 } });
      if (pinned) pinned.lines[name].forEach((values, k) => traces.push(line(pinned.times, values, { color: pinned.colors[k], width: 1, dash: "dash" }, { yaxis: axis, opacity: 0.7 })));
      flight.lines[name].forEach((values, k) =>
        traces.push(line(flight.times, values, { color: flight.colors[k], width: 1.3 }, { yaxis: axis, name: plain(flight.vehicles[k]), hoverinfo: "x+y+name" })));
    });
    const layout = {
      ...base, ...axes, annotations: heads, uirevision: `${flight.name} ${panels.length}`, hovermode: "x", dragmode: isCoarse ? false : "zoom",
      xaxis: { title: { text: "time [s]" }, anchor: `y${panels.length > 1 ? panels.length : ""}`, showspikes: true, spikemode: "across", spikethickness: 1, spikedash: "solid", spikecolor: GRAY },
      margin: { l: 40, r: 8, t: 4, b: 38 }, showlegend: false,
    };
    return { traces, layout };
  };

  const draw = async (flight, pinned, mission) => {
    shown = flight;
    const traces = planTraces(flight, pinned), at = vehicles(flight);
    marker = traces.length;
    traces.push({
      type: "scatter", mode: "markers", x: at.x, y: at.y, showlegend: false, hoverinfo: "text", text: flight.vehicles.map(plain), cliponaxis: true,
      marker: { symbol: "arrow", size: 15, angle: at.angle, color: flight.colors, line: { width: 1, color: "white" } },
    });
    const { traces: lines, layout } = seriesFigure(flight, pinned);
    layout.uirevision += mission;
    const charts = [[plan, traces, planLayout(mission)], [series, lines, layout]];
    clearTimeout(settling);
    await Promise.all(charts.map((chart) => put(...chart)));
    settling = setTimeout(() => charts.forEach(([node, data, look]) => Plotly.react(node, data, look, options)), CALM);
  };
  // Where the same lines still fit between the axes, they alone are moved, which takes a quarter of the time.
  const put = (node, traces, layout) => {
    const fits = node.data && node.layout.uirevision === layout.uirevision && node.data.length === traces.length && traces.every((trace) => fitsIn(node, trace));
    if (!fits) return Plotly.react(node, traces, layout, options);
    const data = traces.map((trace) => ({ x: trace.x, y: trace.y, ...(trace.marker && { "marker.angle": trace.marker.angle }) }));
    const still = { frame: { duration: 0, redraw: false }, transition: { duration: 0 }, mode: "immediate" };
    return Plotly.animate(node, { data, traces: traces.map((_, k) => k) }, still).catch(() => {});
  };
  const fitsIn = (node, { x, y, yaxis = "y" }) => {
    const { xaxis, [yaxis.replace("y", "yaxis")]: axis } = node._fullLayout;
    return within(x, xaxis.range) && within(y, axis.range);
  };
  const within = (values, [low, high]) => values.every((value) => !(value < low || value > high));
  // Pointing at an instant shows where everybody was then.
  const moveTo = (time) => {
    instant = time;
    if (waiting || !shown) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const at = vehicles(shown);
      Plotly.restyle(plan, { x: [at.x], y: [at.y], "marker.angle": [at.angle] }, [marker]);
    });
  };
  const listen = () => {
    series.on("plotly_hover", ({ xvals, points }) => moveTo(xvals ? xvals[0] : points[0].x));
    series.on("plotly_unhover", () => moveTo(null));
  };
  return { draw, listen };
};
