// The page: what was changed, what is asked, what is shown.
import { makeCharts, unpack } from "./charts.js";
import { makeControls } from "./controls.js";
import { openLink } from "./link.js";
import { asList, makePoints } from "./points.js";
import { makeStudy } from "./study.js";
import { showNumbers, showVerdict } from "./tables.js";

const byId = (id) => document.getElementById(id);
const PATIENCE = 500; // [ms] after which a newer flight is asked for though the older one is not there
const LARGEST = 500_000; // bytes of a mission file
const TOO_LARGE = "What was opened or typed is too large to be flown here; ↺ and Reset all take back what was typed.";
const LOST = {
  gone: "The connection to the laboratory is lost: it has ended, or is not answering. Type cardume lab again and open the address that it prints. What you changed is still on this page until you close it.",
  other: "Another laboratory answers here now; this page belongs to one that has ended. Open the address that cardume lab printed last.",
};

const lab = { mission: null, text: null, laws: {}, values: {}, seed: null, points: null, flight: null, pinned: null, pinnedChanges: null, session: "" };
const latencies = [];
let link = null, controls = null, charts = null, points = null, study = null;
let asked = null, wanted = null, number = 0, timer = null;

// ---- what was changed ------------------------------------------------------------------------------------------
const changes = () => ({ laws: lab.laws, values: lab.values, seed: lab.seed });
const isChanged = (control) => control.keys.some((key) => key in lab.values || key in lab.laws);
const dropOf = (keys) => {
  // the parameters of a law go with it
  for (const control of controls.all()) control.keys.forEach((key, k) => { if (keys.includes(control.laws[k])) delete lab.values[key]; });
};
const changed = (control, text) => {
  const given = control.kind === "law" ? lab.laws : lab.values;
  if (control.kind === "law") dropOf(control.keys);
  for (const key of control.keys) given[key] = text;
  noteChanges();
  fly();
};
const reset = (control) => {
  if (control.kind === "law") dropOf(control.keys);
  for (const key of control.keys) { delete lab.values[key]; delete lab.laws[key]; }
  noteChanges();
  fly({ isFresh: true });
};
const resetAll = () => {
  Object.assign(lab, { laws: {}, values: {}, seed: null });
  hidePoints();
  noteChanges();
  fly({ isFresh: true });
};
const noteChanges = () => {
  controls.mark();
  byId("reset").disabled = !Object.keys(lab.values).length && !Object.keys(lab.laws).length && lab.seed === null;
};

// ---- flying ----------------------------------------------------------------------------------------------------
// One flight is under way at a time, and the newest change is flown next; so a slider that is dragged shows every
// state that this machine can keep up with, and ends on the last.
const fly = ({ isFresh = false } = {}) => {
  wanted = { since: performance.now(), isFresh: isFresh || (wanted && wanted.isFresh) || false };
  pump();
};
const pump = () => {
  clearTimeout(timer);
  if (!wanted || !lab.mission) return;
  const age = asked ? performance.now() - asked.sent : Infinity;
  if (age < PATIENCE) { timer = setTimeout(pump, PATIENCE - age); return; }
  asked = { ...wanted, id: ++number, sent: performance.now() };
  wanted = null;
  link.say({ do: "fly", id: asked.id, fresh: asked.isFresh, ...changes() });
};
const landed = async (answer) => {
  const own = asked && answer.id === asked.id ? asked : null;
  if (answer.id !== undefined && answer.id !== null && !own) return; // a newer one is under way
  lab.flight = unpack(answer.flight);
  complain([]);
  if (answer.groups) {
    controls.show(answer.groups);
    noteChanges();
    byId("filter").value && controls.filter(byId("filter").value);
    byId("seed").value = lab.seed ?? answer.seed;
    lab.points = answer.points;
  }
  await show();
  requestAnimationFrame(() => {
    if (own) {
      const taken = performance.now() - own.since;
      latencies.push(taken);
      byId("status").textContent = `flown in ${lab.flight.milliseconds.toFixed(0)} ms, shown after ${taken.toFixed(0)} ms`;
    } else byId("status").textContent = `flown in ${lab.flight.milliseconds.toFixed(0)} ms`;
    document.body.dataset.flown = Number(document.body.dataset.flown ?? 0) + 1;
    document.body.dataset.ready = "yes";
  });
  if (asked === own) asked = null; // a newer one may have been asked for while this one was drawn
  pump();
};
const show = async () => {
  showVerdict(lab.flight);
  showNumbers(lab.flight, lab.pinned, differences());
  study.limits(lab.flight.required);
  await charts.draw(lab.flight, lab.pinned, lab.mission);
  points.place();
};
const differences = () => {
  if (!lab.pinned) return [];
  const then = lab.pinnedChanges, now = { ...lab.laws, ...lab.values, seed: `${byId("seed").value}` };
  const keys = [...new Set([...Object.keys(then), ...Object.keys(now)])].filter((key) => then[key] !== now[key]);
  const labels = new Map();
  for (const control of controls.all()) for (const key of control.keys) labels.set(key, control.label);
  const said = keys.map((key) => `${labels.get(key) ?? key} ${then[key] ?? "as in the file"}, now ${now[key] ?? "as in the file"}`);
  return [...new Set(said)].slice(0, 8);
};

// ---- what goes wrong -------------------------------------------------------------------------------------------
const complain = (problems) => {
  const banner = byId("banner");
  if (banner.classList.contains("lost")) return;
  banner.hidden = problems.length === 0;
  banner.textContent = problems.map((one) => one.message).join("\n");
  controls && controls.wrong(new Set(problems.map((one) => one.key)));
};
const lost = (why) => {
  const banner = byId("banner");
  banner.textContent = LOST[why];
  banner.classList.add("lost");
  banner.hidden = false;
  document.body.classList.add("is-gone");
  document.body.dataset.lost = why;
  study && study.gone();
};
const back = () => {
  byId("banner").classList.remove("lost");
  byId("banner").hidden = true;
  document.body.classList.remove("is-gone");
  delete document.body.dataset.lost;
};

// ---- missions --------------------------------------------------------------------------------------------------
const fillMissions = ({ built_in: builtIn, files }) => {
  const group = (label, options) => {
    const made = document.createElement("optgroup");
    made.label = label;
    made.append(...options);
    return made;
  };
  const option = (name, about = "") => {
    const made = new Option(name, name);
    made.title = about;
    return made;
  };
  const parts = [group("built in", builtIn.map(({ name, about }) => option(name, about)))];
  if (files.length) parts.unshift(group("in the folder", files.map((name) => option(name))));
  byId("mission").replaceChildren(...parts);
};
let opening = null; // the text of the mission that is being opened, if the person brought it along
const open = (name, text = null, more = {}) => {
  [asked, wanted] = [null, null];
  opening = text;
  byId("status").textContent = "opening …";
  link.say({ do: "open", name, ...(text !== null && { text }), ...more });
};
// A new line knows nothing of what was done on the page: the same mission is opened again, with all that was changed.
const openAgain = () => open(lab.mission, lab.text, { again: true, ...changes() });
const opened = ({ name, notes, again }) => {
  if (!again) {
    Object.assign(lab, { mission: name, text: opening, laws: {}, values: {}, seed: null, points: null });
    hidePoints();
    study.forget();
  }
  const select = byId("mission");
  if (![...select.options].some((option) => option.value === name)) select.prepend(new Option(`${name} (opened)`, name));
  select.value = name;
  byId("name").value = name.split("/").pop().replace(/\.[a-z.]+$/, "").replace(/[^A-Za-z0-9_-]/g, "-");
  byId("notes").textContent = notes.join("\n");
  byId("notes").hidden = notes.length === 0;
  document.title = `${name} – cardume lab`;
};
const openFile = async () => {
  const [file] = byId("file").files;
  byId("file").value = "";
  if (!file) return;
  if (file.size > LARGEST) { complain([{ key: "", message: `${file.name} is larger than ${LARGEST} bytes; a mission file holds a few hundred lines` }]); return; }
  open(file.name, await file.text());
};

// ---- saving, report, pin -----------------------------------------------------------------------------------------
const save = (mayReplace) => link.say({ do: "save", name: byId("name").value, replace: mayReplace, ...changes() });
const taken = (message) => {
  byId("taken").textContent = `${message}. Save again to replace it.`;
  byId("taken").hidden = false;
  byId("saving").showModal();
};
const pin = () => {
  lab.pinned = lab.pinned ? null : lab.flight;
  lab.pinnedChanges = lab.pinned && { ...lab.laws, ...lab.values, seed: `${byId("seed").value}` };
  byId("pin").setAttribute("aria-pressed", String(Boolean(lab.pinned)));
  byId("pin").textContent = lab.pinned ? "Unpin" : "Pin";
  show();
};

// ---- waypoints ---------------------------------------------------------------------------------------------------
const hidePoints = () => {
  points.hide();
  byId("drawing").hidden = true;
  byId("waypoints").setAttribute("aria-pressed", "false");
  byId("draw").setAttribute("aria-pressed", "false");
};
const showPoints = (given) => {
  byId("waypoints").setAttribute("aria-pressed", "true");
  byId("drawing").hidden = false;
  points.show(given);
};
const toggleWaypoints = () => {
  if (points.isShown()) hidePoints();
  else if (lab.points) showPoints(lab.points);
  else link.say({ do: "points", ...changes() });
};
const pathChanged = (list) => {
  // a path that has points keeps its kind; any other becomes one of waypoints
  if (lab.points && !lab.laws.path) lab.laws["path.points"] = asList(list);
  else {
    for (const key of [...Object.keys(lab.values)]) if (key.startsWith("path.")) delete lab.values[key];
    lab.laws.path = `{type: waypoints, points: ${asList(list)}}`;
  }
  noteChanges();
  fly();
};
const toggleDrawing = () => {
  const isOn = !points.isDrawing();
  points.draw(isOn);
  byId("draw").setAttribute("aria-pressed", String(isOn));
  byId("draw").textContent = isOn ? "Done" : "Draw anew";
};

// ---- begin -------------------------------------------------------------------------------------------------------
const hello = (answer) => {
  fillMissions(answer);
  byId("folder").textContent = answer.folder;
  if (!controls) {
    controls = makeControls({ node: byId("groups"), changed, isChanged, reset });
    charts = makeCharts({ plan: byId("plan"), series: byId("series"), base: answer.layout });
    points = makePoints({ plan: byId("plan"), handles: byId("handles"), changed: pathChanged });
    study = makeStudy({ say: (message) => link.say(message), base: answer.layout, metrics: answer.metrics, changes });
    Plotly.newPlot(byId("plan"), [], {});
    Plotly.newPlot(byId("series"), [], {});
    byId("plan").on("plotly_relayout", points.place);
    byId("plan").on("plotly_relayouting", points.place);
    byId("plan").on("plotly_afterplot", points.place);
    charts.listen();
  }
  if (lab.mission) openAgain();
  else open(document.body.dataset.mission);
};
const told = (answer) => {
  const does = {
    named: () => { lab.session = answer.name; },
    hello: () => hello(answer),
    opened: () => opened(answer),
    flown: () => landed(answer),
    refused: () => {
      if (answer.of === "open") byId("mission").value = lab.mission ?? "";
      if (asked && answer.id === asked.id) asked = null;
      if (answer.of === "study") study.told({ id: answer.id, problem: answer.problems.map((one) => one.message).join("\n") });
      byId("status").textContent = "not flown";
      complain(answer.problems);
      document.body.dataset.refused = Number(document.body.dataset.refused ?? 0) + 1;
      pump();
    },
    taken: () => taken(answer.problems[0].message),
    saved: () => {
      const now = byId("mission").value;
      const names = [...byId("mission").querySelectorAll("optgroup")].map((group) => group.label);
      byId("status").textContent = `saved as ${answer.name}`;
      if (!names.includes("in the folder")) {
        const group = document.createElement("optgroup");
        group.label = "in the folder";
        byId("mission").prepend(group);
      }
      byId("mission").querySelector("optgroup").replaceChildren(...answer.files.map((name) => new Option(name, name)));
      byId("mission").value = now;
    },
    points: () => showPoints(answer.points),
    progress: () => { byId("status").textContent = `compiling a law, once per installation … ${answer.done} of ${answer.total}`; },
    study: () => study.told(answer),
  }[answer.is];
  if (does) does();
};

byId("mission").addEventListener("change", () => open(byId("mission").value));
byId("open").addEventListener("click", () => byId("file").click());
byId("file").addEventListener("change", openFile);
byId("seed").addEventListener("input", () => {
  const seed = Number(byId("seed").value);
  if (byId("seed").value === "" || !Number.isSafeInteger(seed) || seed < 0) return;
  lab.seed = seed;
  noteChanges();
  fly();
});
byId("reset").addEventListener("click", resetAll);
byId("filter").addEventListener("input", () => controls.filter(byId("filter").value));
byId("pin").addEventListener("click", pin);
byId("waypoints").addEventListener("click", toggleWaypoints);
byId("draw").addEventListener("click", toggleDrawing);
byId("report").addEventListener("click", () => window.open(`report/${lab.session}`, "_blank", "noopener"));
byId("save").addEventListener("click", () => { byId("taken").hidden = true; byId("saving").showModal(); });
byId("saving").addEventListener("close", () => { if (byId("saving").returnValue === "save") save(!byId("taken").hidden); });
byId("name").addEventListener("input", () => { byId("taken").hidden = true; });
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, textarea, dialog")) return;
  const does = { "/": () => byId("filter").focus(), p: pin, w: toggleWaypoints }[event.key.toLowerCase()];
  if (does && lab.flight) { does(); event.preventDefault(); }
});
window.cardume = { lab, latencies, changes };
link = openLink({ told, lost, back, tooLarge: () => { asked = null; complain([{ key: "", message: TOO_LARGE }]); } });
