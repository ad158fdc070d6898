// Many missions in the background, as a histogram that grows.
const byId = (id) => document.getElementById(id);
const GRAY = "#8C8C8C";
const ABOUT = "This mission under many seeds, its own and those after it, flown in the background.";

export const makeStudy = ({ say, base, metrics, changes }) => {
  let values = {}, before = null, done = 0, total = 0, met = null, failed = 0, limits = {}, isOn = false, drawn = 0, timer = null, id = 0;

  const bins = (all, count = 30) => {
    let low = Math.min(...all), high = Math.max(...all);
    if (!(high > low)) { low -= 0.5; high += 0.5; }
    return { start: low, end: high, size: (high - low) / count };
  };
  const draw = () => {
    drawn = performance.now();
    timer = null;
    const name = byId("metric").value, known = (values[name] ?? []).filter((value) => value !== null);
    const other = before && before[name] ? before[name].filter((value) => value !== null) : [];
    const { unit, meaning } = metrics[name] ?? { unit: "", meaning: "" };
    byId("metric").title = meaning;
    const all = [...known, ...other];
    if (!all.length) return Plotly.purge(byId("histogram"));
    const xbins = bins(all), limit = limits[name];
    const traces = [{ type: "histogram", x: known, xbins, autobinx: false, marker: { color: "#0072B2" }, opacity: 0.85, histnorm: "percent", name: "this study", hovertemplate: "%{y:.1f} %<extra></extra>" }];
    if (other.length) traces.push({ type: "histogram", x: other, xbins, autobinx: false, marker: { color: "rgba(0,0,0,0)", line: { color: "#D55E00", width: 1.5 } }, histnorm: "percent", name: "the one before", hovertemplate: "%{y:.1f} %<extra></extra>" });
    const shapes = limit === undefined ? [] : [{ type: "line", x0: limit, x1: limit, yref: "paper", y0: 0, y1: 1, line: { color: GRAY, width: 2, dash: "dash" } }];
    return Plotly.react(byId("histogram"), traces, {
      ...base, barmode: "overlay", shapes, bargap: 0.03, margin: { l: 45, r: 8, t: 18, b: 40 }, showlegend: other.length > 0,
      legend: { orientation: "h", y: 1, yanchor: "bottom", x: 0 },
      xaxis: { title: { text: `${name.replaceAll("_", " ")}${unit ? ` [${unit}]` : ""}` } }, yaxis: { title: { text: "missions [%]" } },
    }, { responsive: true, displayModeBar: false });
  };
  const drawSoon = () => {
    if (timer === null) timer = setTimeout(draw, Math.max(0, 250 - (performance.now() - drawn)));
  };
  const tell = (text) => {
    byId("progress").value = total ? done / total : 0;
    const parts = [text || `${done} of ${total} missions`];
    if (met !== null && done) parts.push(`in ${met} all that is required was met`);
    if (failed) parts.push(`${failed} failed while flying`);
    const known = (values[byId("metric").value] ?? []).filter((value) => value !== null).sort((a, b) => a - b);
    const { unit } = metrics[byId("metric").value] ?? { unit: "" };
    if (known.length) parts.push(`median ${[known[Math.floor(known.length / 2)].toPrecision(3), unit].join(" ").trim()}`);
    byId("found").textContent = `${parts.join("; ")}.`;
  };
  const switched = (isFlying) => {
    isOn = isFlying;
    byId("begin").disabled = isFlying;
    byId("stop").disabled = !isFlying;
  };
  const begin = () => {
    const runs = Math.round(Number(byId("runs").value));
    if (done > 1) before = values;
    [values, done, total, met, failed] = [{}, 0, runs, null, 0];
    switched(true);
    tell(`0 of ${runs} missions`);
    say({ do: "study", id: ++id, runs, ...changes() });
  };
  const ended = (why) => {
    if (!isOn) return;
    switched(false);
    tell(`${why} after ${done} of ${total} missions`);
  };
  const stop = () => {
    say({ do: "stop" });
    ended("stopped");
  };
  // Another mission is there: what was found is about the one before.
  const forget = () => {
    clearTimeout(timer);
    [values, before, done, total, met, failed, timer] = [{}, null, 0, 0, null, 0, null];
    switched(false);
    byId("metric").replaceChildren();
    byId("progress").value = 0;
    byId("found").textContent = ABOUT;
    Plotly.purge(byId("histogram"));
  };
  const told = (answer) => {
    if (!isOn || answer.id !== id) return; // the last portion of a study that was stopped comes late
    if (answer.problem) {
      switched(false);
      byId("found").textContent = answer.problem;
      return;
    }
    for (const [name, more] of Object.entries(answer.metrics)) (values[name] ??= []).push(...more);
    [done, total, failed, met] = [answer.done, answer.total, answer.failed, answer.met];
    if (done >= total) switched(false);
    offer(Object.keys(values));
    tell();
    drawSoon();
  };
  const offer = (names) => {
    const select = byId("metric"), now = [...select.options].map((option) => option.value);
    const useful = names.filter((name) => values[name].some((value) => value !== null));
    if (useful.every((name) => now.includes(name))) return;
    const chosen = select.value, first = Object.keys(limits).find((name) => useful.includes(name)) ?? (useful.includes("cross_track_rms") ? "cross_track_rms" : useful[0]);
    select.replaceChildren(...useful.map((name) => new Option(name.replaceAll("_", " "), name)));
    select.value = useful.includes(chosen) ? chosen : first;
  };
  byId("found").textContent = ABOUT;
  byId("begin").addEventListener("click", begin);
  byId("stop").addEventListener("click", stop);
  byId("metric").addEventListener("change", () => { tell(); draw(); });
  const setLimits = (required) => { limits = Object.fromEntries(required.filter((one) => one.limit !== null).map((one) => [one.metric, one.limit])); };
  return { told, limits: setLimits, gone: () => ended("the connection was lost"), forget };
};
