// Sliders, numbers and choices, made from what the laboratory says of the mission.
const STEPS = 200;
const rounded = (value, digits = 3) => Number(value.toPrecision(digits));

const element = (kind, given = {}, ...inner) => {
  const made = document.createElement(kind);
  for (const [name, value] of Object.entries(given)) {
    if (name in made) made[name] = value; else made.setAttribute(name, value);
  }
  made.append(...inner);
  return made;
};

// Where a value stands on a slider, and back.
const toSlider = (control, value) =>
  control.is_log ? (STEPS * Math.log(Math.max(value, control.start) / control.start)) / Math.log(control.end / control.start) : value;
const fromSlider = (control, position) => {
  if (!control.is_log) return rounded(position, 9);
  const value = control.start * (control.end / control.start) ** (position / STEPS);
  return control.step ? rounded(Math.max(1, Math.round(value / control.step)) * control.step, 9) : rounded(value);
};
export const asText = (control, value) => (control.unit ? `${value} ${control.unit}` : `${value}`);

export const makeControls = ({ node, changed, isChanged, reset }) => {
  let made = [];

  const number = (control, id) => {
    const value = element("input", { id, className: "value", type: "text", inputMode: "decimal", value: `${rounded(control.value, 6)}`, autocomplete: "off" });
    const slider = element("input", { type: "range", className: "slider" });
    slider.setAttribute("aria-label", `${control.label}, slider`);
    slider.min = control.is_log ? 0 : control.start;
    slider.max = control.is_log ? STEPS : control.end;
    slider.step = control.is_log ? 1 : control.kind === "whole" ? 1 : control.step || "any";
    const say = (given) => slider.setAttribute("aria-valuetext", asText(control, given));
    const show = (given) => { value.value = `${rounded(given, 6)}`; slider.value = toSlider(control, given); say(given); };
    slider.addEventListener("input", () => {
      const given = fromSlider(control, Number(slider.value));
      value.value = `${given}`;
      say(given);
      changed(control, control.kind === "whole" ? `${given}` : asText(control, given));
    });
    value.addEventListener("change", () => {
      const text = value.value.trim();
      if (!text) return;
      const plain = Number(text);
      if (Number.isFinite(plain)) { slider.value = toSlider(control, plain); say(plain); }
      changed(control, Number.isFinite(plain) && control.kind !== "whole" ? asText(control, plain) : text);
    });
    show(control.value);
    return { inputs: [value], slider, focus: slider };
  };

  const choice = (control, id) => {
    const options = control.options.map((name) => element("option", { value: name, textContent: name.replaceAll("_", " ") }));
    const select = element("select", { id }, ...options);
    select.value = control.value;
    select.addEventListener("change", () => changed(control, select.value));
    return { inputs: [select], slider: null, focus: select };
  };

  const one = (control, place) => {
    const id = `c${place}`;
    const parts = control.kind === "number" || control.kind === "whole" ? number(control, id) : choice(control, id);
    const again = element("button", { type: "button", className: "again", textContent: "↺", title: "as in the file" });
    again.setAttribute("aria-label", `${control.label}: as in the file`);
    again.addEventListener("click", () => reset(control));
    const unit = element("span", { className: "unit", textContent: control.unit });
    const isChoice = parts.slider === null;
    const head = element("div", { className: "head" }, element("label", { htmlFor: id, textContent: control.label }), again, ...(isChoice ? [] : [...parts.inputs, unit]));
    const meaning = [control.meaning, control.given && `drawn: ${control.given}`].filter(Boolean).join("; ");
    const row = element("div", { className: "control", title: `${control.keys[0]}${control.keys.length > 1 ? " …" : ""}` }, head);
    row.append(...(isChoice ? parts.inputs : [parts.slider]));
    if (meaning) row.append(element("div", { className: "meaning", textContent: meaning }));
    row.dataset.key = control.keys[0];
    made.push({ control, row, ...parts });
    return row;
  };

  const mark = () => {
    for (const { control, row } of made) row.classList.toggle("changed", isChanged(control));
  };
  const show = (groups) => {
    const focused = document.activeElement && document.activeElement.closest(".control");
    const key = focused && focused.dataset.key;
    const isSlider = document.activeElement && document.activeElement.classList.contains("slider");
    const open = new Map([...node.querySelectorAll("details")].map((one) => [one.dataset.title, one.open]));
    const top = node.parentElement.scrollTop;
    made = [];
    let place = 0;
    node.replaceChildren(
      ...groups.map((group) => {
        const rows = group.controls.map((control) => one(control, place++));
        const details = element("details", { open: open.get(group.title) ?? group.open }, element("summary", { textContent: group.title }), ...rows);
        details.dataset.title = group.title;
        return details;
      }),
    );
    mark();
    node.parentElement.scrollTop = top;
    const same = made.find(({ control }) => control.keys[0] === key);
    if (same) (isSlider && same.slider ? same.slider : same.inputs[0]).focus({ preventScroll: true });
  };
  const wrong = (keys) => {
    for (const { control, row } of made) row.classList.toggle("wrong", control.keys.some((key) => keys.has(key)));
  };
  const filter = (text) => {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    for (const details of node.querySelectorAll("details")) {
      let any = false;
      for (const row of details.querySelectorAll(".control")) {
        const said = `${details.dataset.title} ${row.textContent} ${row.dataset.key}`.toLowerCase();
        row.hidden = !words.every((word) => said.includes(word));
        any ||= !row.hidden;
      }
      details.hidden = !any;
      if (words.length && any) details.open = true;
    }
  };
  return { show, mark, wrong, filter, all: () => made.map(({ control }) => control) };
};
