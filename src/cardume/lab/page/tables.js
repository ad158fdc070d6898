// Verdict, requirements and numbers; every text is put in as text.
const byId = (id) => document.getElementById(id);
const cell = (kind, text, className = "", title = "") => {
  const made = document.createElement(kind);
  made.textContent = text;
  if (className) made.className = className;
  if (title) made.title = title;
  return made;
};
const row = (...cells) => {
  const made = document.createElement("tr");
  made.append(...cells);
  return made;
};
const named = (name, color) => {
  const head = cell("th", "", "name", name), swatch = document.createElement("span");
  swatch.className = "swatch";
  swatch.style.background = color;
  head.append(swatch, name);
  return head;
};
const signed = (value) => Math.abs(value) < 1e-9 ? "±0" : `${value > 0 ? "+" : value < 0 ? "−" : "±"}${Math.abs(value).toPrecision(2)}`;

export const showVerdict = (flight) => {
  const [word, kind] = flight.verdict;
  byId("verdict").textContent = word;
  byId("verdict").className = `verdict ${kind}`;
  byId("meaning").textContent = flight.meaning;
  const rows = flight.required.map((one) => {
    const made = row(
      cell("td", one.what), cell("td", one.wanted), cell("td", one.worst ? `${one.got} (${one.worst})` : one.got),
      cell("td", one.met ? "✓ met" : "✗ missed", one.met ? "good" : "bad"),
    );
    made.title = one.meaning;
    return made;
  });
  const head = row(cell("th", "Required"), cell("th", "wanted"), cell("th", "got"), cell("th", ""));
  byId("required").replaceChildren(...(rows.length ? [head, ...rows] : []));
};

export const showNumbers = (flight, pinned, differs) => {
  const before = new Map((pinned ? pinned.numbers : []).map((one) => [one.label, one]));
  const isFleet = flight.vehicles.length > 1, most = pinned ? 0 : 5;
  const heads = flight.vehicles.slice(0, most).map((name, k) => named(name, flight.colors[k]));
  const last = pinned ? [cell("th", "now"), cell("th", "pinned"), cell("th", "change")] : isFleet ? [cell("th", "fleet")] : [];
  const rows = flight.numbers.map((one) => {
    const then = before.get(one.label), texts = pinned ? [] : one.cells.slice(0, Math.min(most, flight.vehicles.length));
    const made = row(cell("td", one.label), ...texts.map((text) => cell("td", text)));
    if (pinned) {
      const known = then && then.value !== null && one.value !== null;
      made.append(cell("td", one.cells.at(-1)), cell("td", then ? then.cells.at(-1) : "–"), cell("td", known ? signed(one.value - then.value) : "–"));
    } else if (isFleet) made.append(cell("td", one.cells.at(-1)));
    made.title = one.meaning;
    return made;
  });
  byId("numbers").replaceChildren(row(cell("th", pinned && isFleet ? "of the fleet" : ""), ...heads, ...last), ...rows);
  byId("pinned").textContent = pinned ? (differs.length ? `Pinned run: ${differs.join("; ")}.` : "The pinned run is this one.") : "";
};
