// What each joint does over time, between its limits.

import { element } from "./dom.js";

const [LEFT, RIGHT, ROW, HEAD] = [52, 10, 84, 18];
const FONT = "12px system-ui, sans-serif";
const COLOURS = {
  light: ["#0072b2", "#b64400", "#00704f", "#a0527f", "#8a5a00", "#3c7aa6", "#5c6166"],
  dark: ["#56b4e9", "#f08a3c", "#2bc79a", "#e59cc6", "#e2b04a", "#9ad0f5", "#a4abb0"],
};
/** Derivative, unit behind that of the joint, and limits, by name. */
const QUANTITIES = {
  position: [0, "", ({ min, max }) => [min, max]],
  speed: [1, "/s", ({ max_velocity: most }) => [-most, most]],
  acceleration: [2, "/s²", ({ max_acceleration: most }) => [-most, most]],
};

const unitOf = (joint) => (joint.unit === "deg" ? "°" : " mm");
const figure = (value) => (Math.abs(value) < 9.95 ? value.toFixed(1) : value.toFixed(0)).replace("-", "−");

export class JointsView {
  /** table: its body gets a row for each joint. */
  constructor(canvas, table) {
    [this.canvas, this.table] = [canvas, table];
    [this.film, this.time, this.quantity] = [null, 0, "position"];
    this.darkness = matchMedia("(prefers-color-scheme: dark)");
    this.darkness.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(film) {
    this.film = film;
    this.values = film && Object.fromEntries(Object.entries(QUANTITIES).map(([name, [order]]) => [name, valuesOf(film, order)]));
    this.canvas.style.height = `${ROW * (film?.joints.length ?? 1) + 24}px`;
    this.table.replaceChildren(...(film?.joints ?? []).map((joint, k) => rowOf(joint, film.extremes[k])));
    this.painted = null;
    this.draw();
  }

  showQuantity(name) {
    this.quantity = name;
    this.draw();
  }

  at(time) {
    this.time = time;
    this.draw();
  }

  draw() {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => this.#draw());
  }

  #draw() {
    const { canvas, film } = this;
    if (!canvas.clientWidth || !film) return;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const key = [width, height, this.quantity, this.darkness.matches].join(" ");
    if (this.painted?.key !== key) this.painted = { key, bitmap: this.#bitmap(width, height, ratio) };
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    context.drawImage(this.painted.bitmap, 0, 0);
    context.scale(ratio, ratio);
    const x = this.#x(this.time);
    const ink = getComputedStyle(canvas).getPropertyValue("--ink").trim();
    context.strokeStyle = context.fillStyle = ink;
    context.beginPath();
    context.moveTo(x, 4);
    context.lineTo(x, ROW * film.joints.length);
    context.stroke();
    context.font = FONT;
    context.textAlign = "right";
    const values = this.values[this.quantity];
    const sample = Math.min(Math.round(((this.time - film.begin) * film.rate) / film.every), values.length / film.joints.length - 1);
    film.joints.forEach((joint, k) => {
      const now = `${figure(values[sample * film.joints.length + k])}${unitOf(joint)}${QUANTITIES[this.quantity][1]}`;
      context.fillText(now, canvas.clientWidth - RIGHT, k * ROW + 14);
    });
  }

  #x(time) {
    const { begin, duration } = this.film;
    return LEFT + ((this.canvas.clientWidth - LEFT - RIGHT) * (time - begin)) / (duration || 1);
  }

  /** All but what changes with time. */
  #bitmap(width, height, ratio) {
    const { canvas, film } = this;
    const bitmap = element("canvas", "", { width, height });
    const context = bitmap.getContext("2d");
    context.scale(ratio, ratio);
    const style = getComputedStyle(canvas);
    const [ink, quiet, line, limit] = ["--ink", "--quiet", "--line", "--bad"].map((name) => style.getPropertyValue(name).trim());
    const [, perSecond, limitsOf] = QUANTITIES[this.quantity];
    const values = this.values[this.quantity];
    const [n, right] = [film.joints.length, canvas.clientWidth - RIGHT];
    const colours = COLOURS[this.darkness.matches ? "dark" : "light"];
    context.font = FONT;
    film.joints.forEach((joint, k) => {
      const [top, bottom] = [k * ROW + HEAD + 6, (k + 1) * ROW - 6];
      const [low, high] = limitsOf(joint);
      const y = (value) => bottom - ((bottom - top) * (value - low)) / (high - low || 1);
      context.fillStyle = ink;
      context.textAlign = "left";
      context.fillText(joint.name, LEFT, k * ROW + 14);
      context.fillStyle = quiet;
      context.textAlign = "right";
      const unit = joint.unit === "deg" && !perSecond ? "°" : "";
      for (const value of [low, high]) context.fillText(figure(value) + unit, LEFT - 6, y(value) + 4);
      context.strokeStyle = limit;
      context.setLineDash([5, 4]);
      strokeLines(context, [low, high].map((value) => [[LEFT, y(value)], [right, y(value)]]));
      context.setLineDash([]);
      context.strokeStyle = line;
      if (low < 0 && high > 0) strokeLines(context, [[[LEFT, y(0)], [right, y(0)]]]);
      context.strokeStyle = colours[k % colours.length];
      context.lineWidth = 1.6;
      strokeLines(context, [profile(values, n, k, right - LEFT).map(([share, value]) => [LEFT + share * (right - LEFT), y(value)])]);
      context.lineWidth = 1;
    });
    context.fillStyle = quiet;
    context.textAlign = "center";
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800].find((each) => film.duration / each <= (right - LEFT) / 50) ?? 3600;
    for (let time = Math.ceil(film.begin / step) * step; time <= film.end + 1e-9; time += step) {
      const at = this.#x(time);
      strokeLines(context, [[[at, n * ROW], [at, n * ROW + 4]]]);
      context.fillText(`${Number(time.toFixed(1))} s`, Math.min(at, right - 10), n * ROW + 17);
    }
    return bitmap;
  }
}

/** A derivative by central differences, like film.positions; at rest before and after. */
function valuesOf({ positions, joints, rate, every }, order) {
  if (!order) return positions;
  const [n, step] = [joints.length, every / rate];
  const found = new Float64Array(positions.length);
  for (let i = 0; i < positions.length; i++) {
    const [before, after] = [positions[i < n ? i : i - n], positions[i + n < positions.length ? i + n : i]];
    found[i] = order === 1 ? (after - before) / (2 * step) : (after - 2 * positions[i] + before) / step ** 2;
  }
  return found;
}

/** [[share of the time, value], ...] of a joint: least and most of what falls in each pixel. */
function profile(values, n, k, pixels) {
  const count = values.length / n;
  const each = Math.max(count / pixels, 1);
  const points = [];
  for (let begin = 0; begin < count; begin += each) {
    let [low, high] = [Math.floor(begin), Math.floor(begin)];
    for (let i = low; i < Math.min(begin + each, count); i++) {
      if (values[i * n + k] < values[low * n + k]) low = i;
      if (values[i * n + k] > values[high * n + k]) high = i;
    }
    for (const i of low === high ? [low] : [Math.min(low, high), Math.max(low, high)]) points.push([i / (count - 1 || 1), values[i * n + k]]);
  }
  return points;
}

function strokeLines(context, lines) {
  context.beginPath();
  for (const [first, ...rest] of lines) {
    context.moveTo(...first);
    for (const point of rest) context.lineTo(...point);
  }
  context.stroke();
}

function rowOf(joint, { min, max, velocity, acceleration }) {
  const row = element("tr");
  const unit = unitOf(joint);
  row.append(
    element("th", joint.name, { scope: "row" }),
    element("td", `${figure(min)} to ${figure(max)}${unit}, of ${figure(joint.min)} to ${figure(joint.max)}${unit}`),
    element("td", `${figure(velocity)} of ${figure(joint.max_velocity)}${unit}/s`),
    element("td", `${figure(acceleration)} of ${figure(joint.max_acceleration)}${unit}/s²`),
  );
  return row;
}
