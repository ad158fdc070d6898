"use strict";
// What moves on the page: Plotly draws, this fetches the numbers of an instant and hands them over.
(() => {
  const report = JSON.parse(document.getElementById("report-data").textContent);
  const kinds = { f4: Float32Array, f8: Float64Array, i4: Int32Array, u1: Uint8Array };
  const decode = ({ dtype, bdata }) =>
    new kinds[dtype](Uint8Array.from(atob(bdata), (c) => c.charCodeAt(0)).buffer);
  const byId = (id) => document.getElementById(id);

  const times = decode(report.store.times);
  const columns = {};
  for (const [name, packed] of Object.entries(report.store.columns)) {
    columns[name] = packed.map((column) => (column ? decode(column) : null));
  }
  const messages = {};
  for (const [name, packed] of Object.entries(report.messages)) messages[name] = decode(packed);
  const size = report.vehicles.length;
  const last = times.length ? times[times.length - 1] : 0;
  const record = times.length > 1 ? times[1] - times[0] : 1;

  // ---- the charts ----------------------------------------------------------------------------------------------
  const resolve = (value) =>
    value && value.from === "times" ? times
    : value && value.from ? columns[value.from][value.vehicle]
    : value && value.bdata ? decode(value)
    : value;
  const filled = (figure) =>
    figure.data.map((trace) => ({ ...trace, x: resolve(trace.x), y: resolve(trace.y), ...(trace.z && { z: resolve(trace.z) }) }));
  const options = {
    responsive: true,
    displaylogo: false,
    scrollZoom: false,
    modeBarButtonsToRemove: ["sendChartToCloud", "select2d", "lasso2d", "autoScale2d", "resetCameraLastSave3d"],
    plotlyServerURL: "",
  };
  const draw = (id) => {
    const { layout } = report.figures[id];
    // a finger that moves over a chart scrolls the page
    if (matchMedia("(pointer: coarse)").matches && !layout.scene) layout.dragmode = false;
    return Plotly.newPlot(byId(id), filled(report.figures[id]), layout, { ...options, displayModeBar: window.innerWidth > 700 });
  };

  // ---- an instant ----------------------------------------------------------------------------------------------
  const place = (time) => {
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    const span = high > low ? times[high] - times[low] : 1;
    return [low, Math.max(low, high), Math.min(1, Math.max(0, (time - times[low]) / span))];
  };
  const at = (name, vehicle, [low, high, share]) => {
    const column = columns[name][vehicle];
    if (share === 0) return column[low];
    return share === 1 ? column[high] : column[low] + share * (column[high] - column[low]);
  };
  const state = (time) => {
    const where = place(time);
    const all = {};
    for (const name of report.moved) all[name] = report.vehicles.map((_, k) => at(name, k, where));
    return all;
  };
  // Messages under way; each is shown for `hold` seconds at least, so that the eye can follow it.
  const firstAfter = (time) => {
    let low = 0, high = messages.sent.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (messages.sent[middle] < time) low = middle + 1; else high = middle;
    }
    return low;
  };
  const flying = (time, hold) => {
    const found = [];
    for (let m = firstAfter(time - Math.max(hold, report.slowest)); m < messages.sent.length && messages.sent[m] <= time; m++) {
      const lost = messages.lost[m] > 0;
      const lasts = Math.max(lost ? 0 : messages.received[m] - messages.sent[m], hold);
      const share = (time - messages.sent[m]) / lasts;
      if (share >= 0 && share < 1) found.push({ from: messages.sender[m], to: messages.receiver[m], lost, share: lost ? Math.min(share, 0.5) : share });
    }
    return found;
  };
  const joined = (pairs) => {
    const lines = { x: [], y: [], z: [] };
    for (const [a, b] of pairs) for (const axis of ["x", "y", "z"]) lines[axis].push(a[axis], b[axis], null);
    return lines;
  };
  const points = (list) => ({ x: list.map((p) => p.x), y: list.map((p) => p.y), z: list.map((p) => p.z) });

  // The curve n' P^-1 n = bound about where a vehicle believes to be: half axes along the eigenvectors of P.
  const ellipse = (vehicle, time, { x, y }) => {
    const where = place(time);
    const [north, both, east] = report.ellipses.covariance.map((name) => at(name, vehicle, where));
    const [mean, root] = [(north + east) / 2, Math.hypot((north - east) / 2, both)];
    if (!(mean > 0)) return points([]); // it does not say
    const [long, short] = [mean + root, Math.max(0, mean - root)].map((value) => Math.sqrt(report.ellipses.bound * value));
    const turn = Math.atan2(2 * both, north - east) / 2; // of the long axis, from north
    return points(Array.from({ length: 49 }, (_, k) => {
      const [along, across] = [long * Math.cos((k * Math.PI) / 24), short * Math.sin((k * Math.PI) / 24)];
      return { x: x + along * Math.sin(turn) + across * Math.cos(turn), y: y + along * Math.cos(turn) - across * Math.sin(turn) };
    }));
  };

  const moved = (time) => {
    const now = state(time);
    const true_ = report.vehicles.map((_, k) => ({ x: now.east[k], y: now.north[k], z: now.depth[k] }));
    const believed = report.vehicles.map((_, k) => ({ x: now.east_estimate[k], y: now.north_estimate[k], z: now.depth[k] }));
    const ahead = (k, reach) => ({ x: now.east[k] + reach * Math.sin(now.heading[k]), y: now.north[k] + reach * Math.cos(now.heading[k]), z: now.depth[k] });
    const current = (k) => ({ x: now.east[k] + report.arrow * now.current_east[k], y: now.north[k] + report.arrow * now.current_north[k], z: now.depth[k] });
    const between = ({ from, to, share }) => {
      const [a, b] = [true_[from], true_[to]];
      return { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y), z: a.z + share * (b.z - a.z) };
    };
    const travelling = flying(time, playing.on ? Math.max(0.15 * speed(), record) : record);
    const [arriving, lost] = [travelling.filter((m) => !m.lost), travelling.filter((m) => m.lost)];
    const line = (m) => [true_[m.from], true_[m.to]];
    return {
      now,
      traces: {
        ...Object.fromEntries(report.ellipses.vehicles.map((k) => [`ellipse_${k}`, ellipse(k, time, believed[k])])),
        vehicles: points(true_),
        believed: points(believed),
        doubts: joined(true_.map((p, k) => [p, believed[k]])),
        currents: report.arrow ? joined(true_.map((p, k) => [p, current(k)])) : points([]),
        links: joined(arriving.map(line)),
        lost_links: joined(lost.map((m) => [true_[m.from], between(m)])),
        dots: points(arriving.map(between)),
        crosses: points(lost.map(between)),
        drops: joined(true_.map((p) => [p, { ...p, z: 0 }])),
        noses: joined(true_.map((p, k) => [p, ahead(k, report.figures.space.nose)])),
      },
    };
  };
  // Plotly.animate without a redraw moves these traces alone; three dimensions are always drawn as a whole.
  const update = (id, traces, headings) => {
    const { moving, layout } = report.figures[id];
    const names = Object.keys(moving);
    if (layout.scene) {
      const axes = { x: [], y: [], z: [] };
      for (const axis of ["x", "y", "z"]) axes[axis] = names.map((name) => traces[name][axis]);
      return Plotly.restyle(byId(id), axes, names.map((name) => moving[name]));
    }
    const data = names.map((name) => ({ x: traces[name].x, y: traces[name].y, ...(name === "vehicles" && { "marker.angle": headings }) }));
    const still = { frame: { duration: 0, redraw: false }, transition: { duration: 0 }, mode: "immediate" };
    return Plotly.animate(byId(id), { data, traces: names.map((name) => moving[name]) }, still).catch(() => {}); // overtaken
  };
  // A line across all panels, laid over the chart: to move it costs nothing.
  const moveCursor = () => {
    const { xaxis, _size } = byId("series")._fullLayout;
    const [left, style] = [xaxis.l2p(time), byId("cursor").style];
    style.display = left < 0 || left > xaxis._length ? "none" : "block";
    style.left = `${_size.l + left}px`;
    style.top = `${_size.t}px`;
    style.height = `${_size.h}px`;
  };

  // ---- the controls --------------------------------------------------------------------------------------------
  const slider = byId("time"), playing = { since: 0, from: 0, on: false };
  const speed = () => Number(byId("speed").value);
  const isVisible = (id) => {
    const box = byId(id).getBoundingClientRect();
    return box.bottom > 0 && box.top < window.innerHeight;
  };
  let time = 0;
  const shown = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : "–");
  const fillTable = (now) => {
    const rows = byId("now").tBodies[0].rows;
    for (let k = 0; k + 1 < rows[0].cells.length; k++) {
      const error = Math.hypot(now.north_estimate[k] - now.north[k], now.east_estimate[k] - now.east[k]);
      const heading = (((now.heading[k] * 180) / Math.PI) % 360 + 360) % 360;
      const values = [
        [now.north[k], 2], [now.east[k], 2], [now.depth[k], 1], [heading, 0], [now.speed[k], 2],
        [now.cross_track[k], 2], [now.cross_track_estimate[k], 2], [error, 2],
      ];
      values.forEach(([value, digits], row) => { rows[row].cells[k + 1].textContent = shown(value, digits); });
    }
  };
  // What goes wrong at this instant, in words below the numbers; and a mark below the slider while each fault lasts.
  const tellFaults = () => {
    const told = report.faults.filter(({ begin, end }) => begin <= time && time < end);
    byId("faults").hidden = !told.length;
    byId("faults").replaceChildren(...told.map(({ words, color }) => {
      const item = document.createElement("li");
      item.textContent = words;
      item.style.borderColor = color;
      return item;
    }));
  };
  const markFaults = () => byId("marks").replaceChildren(...report.faults.map(({ begin, end, color }) => {
    const mark = document.createElement("i");
    mark.style.left = `${(100 * begin) / last}%`;
    mark.style.width = `${(100 * (end - begin)) / last}%`;
    mark.style.background = color;
    return mark;
  }));
  const setTime = (wanted, isFinal = true) => {
    if (!times.length) return;
    time = Math.min(last, Math.max(0, wanted));
    slider.value = time;
    const text = `${time.toFixed(record < 1 ? 1 : 0)} s`;
    byId("clock").textContent = text;
    byId("instant").textContent = text;
    slider.setAttribute("aria-valuetext", text);
    const { now, traces } = moved(time);
    fillTable(now);
    tellFaults();
    moveCursor();
    if (isFinal || isVisible("plan")) update("plan", traces, now.heading.map((angle) => (angle * 180) / Math.PI));
    if (isFinal || isVisible("space")) update("space", traces);
  };
  const stop = () => {
    playing.on = false;
    byId("play").textContent = "▶ Play";
    byId("play").setAttribute("aria-pressed", "false");
    setTime(time);
  };
  const frame = (stamp) => {
    if (!playing.on) return;
    const wanted = playing.from + ((stamp - playing.since) / 1000) * speed();
    setTime(wanted, false);
    if (wanted >= last) stop(); else requestAnimationFrame(frame);
  };
  const start = () => {
    playing.from = time >= last ? 0 : time;
    playing.since = performance.now();
    playing.on = true;
    byId("play").textContent = "❚❚ Pause";
    byId("play").setAttribute("aria-pressed", "true");
    requestAnimationFrame(frame);
  };
  const toggle = () => (playing.on ? stop() : start());
  const listen = () => {
    byId("play").addEventListener("click", toggle);
    slider.addEventListener("input", () => { if (playing.on) stop(); setTime(Number(slider.value)); });
    byId("speed").addEventListener("change", () => { playing.from = time; playing.since = performance.now(); });
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const isControl = event.target.closest("input, select, button, a");
      if (event.key === " " && !isControl) { toggle(); event.preventDefault(); }
      const step = { ArrowRight: record, ArrowLeft: -record, PageUp: last / 20, PageDown: -last / 20 }[event.key];
      if (step && (event.target === slider || (!isControl && event.key.startsWith("Arrow")))) {
        if (playing.on) stop();
        setTime(Math.round((time + step) / record) * record);
        event.preventDefault();
      }
    });
    byId("series").on("plotly_click", ({ points: [point] }) => { if (playing.on) stop(); setTime(point.x); });
    byId("series").on("plotly_relayout", moveCursor);
    byId("series").on("plotly_afterplot", moveCursor);
    const series = report.figures.series, { width } = series.printed;
    const axes = (domains, most) => Object.fromEntries(domains.flatMap((domain, k) => {
      const name = `yaxis${k ? k + 1 : ""}`;
      return [[`${name}.domain`, domain], [`${name}.nticks`, Math.min(most, series.layout[name].nticks)]];
    }));
    window.addEventListener("beforeprint", () => {
      if (playing.on) stop();
      // twice: only the second time a legend of other lines stands where the axes of the first time end
      for (let k = 0; k < 2; k++) Plotly.relayout(byId("plan"), { width, autosize: false });
      Plotly.relayout(byId("series"), { width, height: series.printed.height, autosize: false, ...axes(series.printed.domains, 4) });
    });
    window.addEventListener("afterprint", () => {
      Plotly.relayout(byId("plan"), { width: null, autosize: true });
      Plotly.relayout(byId("series"), { width: null, height: series.height, autosize: true, ...axes(series.domains, 9) });
    });
  };

  const begin = async () => {
    if (!times.length) return;
    for (const id of ["plan", "space", "series"]) {
      await draw(id);
      await new Promise((goOn) => setTimeout(goOn)); // what is drawn is seen before the next begins
    }
    slider.max = last;
    slider.step = record;
    const usual = last / 45; // about as many seconds of playing
    const speeds = [...byId("speed").options].map((option) => Number(option.value));
    byId("speed").value = speeds.reduce((best, s) => (Math.abs(Math.log(s / usual)) < Math.abs(Math.log(best / usual)) ? s : best));
    listen();
    markFaults();
    setTime(report.start);
    document.body.dataset.ready = "yes";
  };
  window.cardume = { setTime, time: () => time };
  begin();
})();
