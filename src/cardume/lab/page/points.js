// Waypoints on the plan: buttons over the chart, to be dragged, or moved with the arrow keys.
const MOVES = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1] };

export const makePoints = ({ plan, handles, changed }) => {
  let points = [], isShown = false, isDrawing = false;

  const frame = () => {
    const { xaxis, yaxis, _size } = plan._fullLayout;
    const box = { left: _size.l + _size.w * xaxis.domain[0], top: _size.t + _size.h * (1 - yaxis.domain[1]), width: xaxis._length, height: yaxis._length };
    for (const side of ["left", "top", "width", "height"]) handles.style[side] = `${box[side]}px`;
    return { xaxis, yaxis };
  };
  const place = () => {
    if (!isShown || !plan._fullLayout) return;
    const { xaxis, yaxis } = frame();
    [...handles.children].forEach((handle, k) => {
      handle.style.left = `${xaxis.l2p(points[k][1])}px`;
      handle.style.top = `${yaxis.l2p(points[k][0])}px`;
    });
  };
  const at = (event) => {
    const { xaxis, yaxis } = frame(), box = handles.getBoundingClientRect();
    const round = (value) => Math.round(value * 10) / 10;
    return [round(yaxis.p2l(event.clientY - box.top)), round(xaxis.p2l(event.clientX - box.left))];
  };
  const name = (handle, k) => {
    const [north, east] = points[k];
    handle.setAttribute("aria-label", `waypoint ${k + 1} of ${points.length}: ${north} m north, ${east} m east`);
  };
  const moved = (handle, k, to) => {
    points[k] = to;
    name(handle, k);
    place();
    changed(points);
  };
  const handleOf = (k) => {
    const handle = document.createElement("button");
    handle.type = "button";
    handle.className = "handle";
    name(handle, k);
    let held = null;
    handle.addEventListener("pointerdown", (event) => { held = event.pointerId; handle.setPointerCapture(held); handle.focus({ preventScroll: true }); event.preventDefault(); });
    handle.addEventListener("pointermove", (event) => { if (event.pointerId === held) moved(handle, k, at(event)); });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => { held = null; });
    handle.addEventListener("keydown", (event) => {
      const move = MOVES[event.key], step = event.shiftKey ? 10 : 1;
      if (move) moved(handle, k, [points[k][0] + step * move[0], points[k][1] + step * move[1]]);
      else if (event.key === "Delete" && points.length > 2) { points.splice(k, 1); rebuild(Math.min(k, points.length - 1)); changed(points); }
      else if (event.key === "Insert") {
        const next = points[k + 1] ?? [points[k][0] + 10, points[k][1]];
        points.splice(k + 1, 0, [(points[k][0] + next[0]) / 2, (points[k][1] + next[1]) / 2]);
        rebuild(k + 1);
        changed(points);
      } else return;
      event.preventDefault();
      event.stopPropagation();
    });
    return handle;
  };
  const rebuild = (focus = null) => {
    handles.replaceChildren(...(isShown ? points.map((_, k) => handleOf(k)) : []));
    place();
    if (focus !== null && handles.children[focus]) handles.children[focus].focus({ preventScroll: true });
  };
  const draw = (isOn) => {
    isDrawing = isOn;
    handles.classList.toggle("drawing", isOn);
    if (isOn) { points = []; rebuild(); }
  };
  handles.addEventListener("pointerdown", (event) => {
    if (!isDrawing) return;
    points.push(at(event));
    rebuild();
    if (points.length > 1) changed(points);
    event.preventDefault();
  });
  return {
    show: (given) => { points = given.map((point) => [...point]); isShown = true; rebuild(); },
    hide: () => { isShown = false; draw(false); rebuild(); },
    draw,
    place,
    isShown: () => isShown,
    isDrawing: () => isDrawing,
  };
};
export const asList = (points) => `[${points.map(([north, east]) => `{north: ${north} m, east: ${east} m}`).join(", ")}]`;
