// The sheet: paper, what the arm reaches, and the drawing, which people move, size and turn by hand.

import { brushOf } from "./dom.js";
import { ErrorMap } from "./error_map.js";
import { Ink, Reel } from "./ink.js";
import { PaintedOnce } from "./painted_once.js";
import { canvasOf, placed } from "./placement.js";

const HANDLE = 9;
const SMALLEST = 0.01;
const rounded = (value, digits = 2) => Number(value.toFixed(digits));

export class Sheet {
  /** changed: called with `{at, scale, rotate}` as somebody moves the drawing, and once more when it is let go. */
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.arm = this.lines = this.options = this.film = null;
    this.showsMap = false;
    /** Whether the drawing is left where it is: while an arm draws it. */
    this.isLocked = false;
    this.until = Infinity;
    this.drag = null;
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    canvas.addEventListener("pointerdown", (event) => this.#grab(event));
    canvas.addEventListener("pointermove", (event) => this.#pull(event));
    for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => this.#letGo());
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  /** lines: null for no drawing. film: of the plan, drawn in the place of the lines, or null. */
  show({ arm, lines, options, film }) {
    if (arm !== undefined) {
      this.arm = arm;
      this.map = arm?.map ? new ErrorMap(arm.map) : null;
      this.zone = arm?.canvas_mm ? zoneOf(arm, canvasOf(arm)) : null;
      this.paintedZone = new PaintedOnce();
    }
    if (lines !== undefined && lines !== this.lines) {
      this.lines = lines;
      this.ink = lines && new Ink(lines);
    }
    if (options !== undefined) this.options = options;
    if (film !== undefined && film !== this.film) {
      this.film = film;
      this.reel = film && new Reel(film);
    }
    this.draw();
  }

  get placement() {
    return this.lines && this.options && this.arm?.canvas_mm && placed(this.lines, canvasOf(this.arm), this.options);
  }

  draw() {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => this.#draw());
  }

  #draw() {
    const { canvas } = this;
    if (!canvas.clientWidth) return;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = brushOf(canvas);
    const colour = (name) => getComputedStyle(canvas).getPropertyValue(name).trim();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!this.arm?.canvas_mm) return;
    const mm = canvasOf(this.arm);
    const placement = this.placement;
    this.view = viewOf(this.arm, mm, placement, width, height);
    const { scale, x, y } = this.view;
    const px = 1 / scale;
    context.setTransform(scale, 0, 0, scale, x, y);
    const fill = colour("--zone");
    this.paintedZone.draw(context, (brush) => {
      brush.fillStyle = fill;
      brush.fill(this.zone);
    }, fill);
    const sheet = placement?.paper.sheet;
    context.fillStyle = colour("--paper");
    if (sheet) context.fillRect(sheet.left, sheet.top, sheet.width, sheet.height);
    else context.fillRect(0, 0, mm.width, mm.height);
    if (this.showsMap) this.map?.draw(context, mm);
    context.setLineDash([6 * px, 4 * px]);
    context.strokeStyle = "#8a8f94";
    context.lineWidth = 1.5 * px;
    context.strokeRect(0, 0, mm.width, mm.height);
    context.setLineDash([]);
    if (sheet) context.strokeRect(sheet.left, sheet.top, sheet.width, sheet.height);
    drawBase(context, baseOf(this.arm, mm), colour, px);
    if (this.film) this.#drawFilm(context, mm, px);
    else if (placement) this.#drawLines(context, placement, colour);
    const isWhole = !this.film || this.until >= this.film.n_samples - 1.5;
    if (placement && isWhole && !this.isLocked) this.#drawHandles(context, placement, px, colour);
    drawRuler(context, this.view, width, height, ratio, colour);
  }

  #drawLines(context, placement, colour) {
    const { room } = placement.paper;
    const { scale, x, y } = this.view;
    const isMoving = this.drag !== null && this.drag.kind !== "move";
    const ink = (style) => this.ink.draw(context, new DOMMatrix([scale, 0, 0, scale, x, y]), placement, isMoving, style);
    if (placement.over > 0.01) {
      ink(colour("--bad"));
      context.save();
      context.beginPath();
      context.rect(room.left, room.top, room.width, room.height);
      context.clip();
      context.fillStyle = colour("--paper");
      context.fillRect(room.left, room.top, room.width, room.height);
      ink();
      context.restore();
    } else ink();
  }

  #drawFilm(context, mm, px) {
    const { scale, x, y } = this.view;
    // arm (x, y) to the sheet: X = left - y, Y = far - x
    const toPixels = new DOMMatrix([scale, 0, 0, scale, x, y]).multiply(new DOMMatrix([0, -1, -1, 0, mm.left, mm.far]));
    this.reel.draw(context, toPixels, px, this.until);
  }

  #drawHandles(context, placement, px, colour) {
    const { corner, size, factor } = placement;
    const [width, height] = [size[0] * factor, size[1] * factor];
    context.strokeStyle = context.fillStyle = placement.over > 0.01 ? colour("--bad") : "#0072b2";
    context.lineWidth = 1.5 * px;
    context.strokeRect(corner[0], corner[1], width, height);
    const side = HANDLE * px;
    for (const [x, y] of cornersOf(placement)) context.fillRect(x - side / 2, y - side / 2, side, side);
    const [x, y] = turnHandle(placement, px);
    context.beginPath();
    context.moveTo(corner[0] + width / 2, corner[1]);
    context.lineTo(x, y);
    context.stroke();
    context.beginPath();
    context.arc(x, y, side * 0.65, 0, 2 * Math.PI);
    context.fill();
  }

  #place(event) {
    const box = this.canvas.getBoundingClientRect();
    const ratio = this.canvas.width / box.width;
    const { scale, x, y } = this.view;
    return [((event.clientX - box.left) * ratio - x) / scale, ((event.clientY - box.top) * ratio - y) / scale];
  }

  #grab(event) {
    const placement = this.placement;
    if (!placement || this.isLocked || !this.view) return;
    const place = this.#place(event);
    const near = ([x, y]) => Math.hypot(place[0] - x, place[1] - y) * this.view.scale < 2.2 * HANDLE;
    const corner = cornersOf(placement).findIndex(near);
    const [width, height] = placement.size.map((side) => side * placement.factor);
    const within = place[0] >= placement.corner[0] && place[0] <= placement.corner[0] + width
      && place[1] >= placement.corner[1] && place[1] <= placement.corner[1] + height;
    const kind = near(turnHandle(placement, 1 / this.view.scale)) ? "turn" : corner >= 0 ? "size" : within ? "move" : null;
    if (!kind) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.drag = { kind, place, corner, placement, rotate: this.options.rotate };
    event.preventDefault();
  }

  #pull(event) {
    if (!this.drag) return;
    const { kind, place, corner, placement, rotate } = this.drag;
    const now = this.#place(event);
    if (kind === "move") this.#put([placement.corner[0] + now[0] - place[0], placement.corner[1] + now[1] - place[1]], placement);
    else if (kind === "size") {
      const fixed = cornersOf(placement)[(corner + 2) % 4];
      const before = Math.hypot(place[0] - fixed[0], place[1] - fixed[1]);
      const share = Math.hypot(now[0] - fixed[0], now[1] - fixed[1]) / Math.max(before, 1e-6);
      const factor = Math.max(placement.factor * share, SMALLEST);
      const [width, height] = placement.size.map((side) => side * factor);
      const at = [corner === 0 || corner === 3 ? fixed[0] - width : fixed[0], corner < 2 ? fixed[1] - height : fixed[1]];
      this.#put(at, { ...placement, factor });
    } else {
      const middle = placement.corner.map((edge, axis) => edge + (placement.size[axis] * placement.factor) / 2);
      const angle = ([x, y]) => (Math.atan2(y - middle[1], x - middle[0]) * 180) / Math.PI;
      let turn = rotate + angle(now) - angle(place);
      turn = event.shiftKey ? Math.round(turn / 15) * 15 : Math.round(turn);
      this.#turn(turn, placement, middle);
    }
  }

  /** Puts the top left corner of what is placed somewhere. */
  #put(corner, placement, rotate = this.options.rotate) {
    const { begin, factor } = placement;
    this.changed({
      at: [rounded(corner[0] - begin.left), rounded(corner[1] - begin.top)],
      scale: rounded(factor, 5),
      rotate: rounded(rotate, 3),
    });
  }

  #turn(rotate, placement, middle) {
    rotate = (((rotate + 180) % 360) + 360) % 360 - 180;
    const after = placed(this.lines, canvasOf(this.arm), { ...this.options, rotate, scale: placement.factor, at: [0, 0] });
    const corner = middle.map((edge, axis) => edge - (after.size[axis] * placement.factor) / 2);
    this.#put(corner, { ...placement, begin: after.begin }, rotate);
  }

  #letGo() {
    this.drag = null;
    this.draw();
  }

  #key(event) {
    const placement = this.placement;
    if (!placement || this.isLocked) return;
    const step = event.shiftKey ? 10 : 1;
    const move = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
    const middle = placement.corner.map((edge, axis) => edge + (placement.size[axis] * placement.factor) / 2);
    if (move) this.#put(placement.corner.map((edge, axis) => edge + move[axis]), placement);
    else if (event.key === "+" || event.key === "=" || event.key === "-") {
      const factor = placement.factor * (event.key === "-" ? 1 / 1.05 : 1.05);
      this.#put(middle.map((edge, axis) => edge - (placement.size[axis] * factor) / 2), { ...placement, factor });
    } else if (event.key === "[" || event.key === "]") {
      this.#turn(this.options.rotate + (event.key === "[" ? -1 : 1) * (event.shiftKey ? 15 : 1), placement, middle);
    } else if (event.key === "f") this.changed(null);
    else return;
    event.preventDefault();
  }
}

function cornersOf({ corner: [x, y], size, factor }) {
  const [width, height] = [size[0] * factor, size[1] * factor];
  return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
}

const turnHandle = ({ corner: [x, y], size, factor }, px) => [x + (size[0] * factor) / 2, y - 28 * px];

/** Everything that there is to see, with room about it. */
function viewOf(arm, mm, placement, width, height) {
  const sheet = placement?.paper.sheet;
  const base = baseOf(arm, mm);
  const low = base.map((edge) => Math.min(edge, 0));
  const high = [Math.max(mm.width, base[0]), Math.max(mm.height, base[1])];
  if (sheet) {
    low[0] = Math.min(low[0], sheet.left);
    low[1] = Math.min(low[1], sheet.top);
    high[0] = Math.max(high[0], sheet.left + sheet.width);
    high[1] = Math.max(high[1], sheet.top + sheet.height);
  }
  const margin = 0.06 * Math.max(high[0] - low[0], high[1] - low[1]);
  const scale = Math.min(width / (high[0] - low[0] + 2 * margin), height / (high[1] - low[1] + 2 * margin));
  return {
    scale,
    x: (width - scale * (low[0] + high[0])) / 2,
    y: (height - scale * (low[1] + high[1])) / 2,
  };
}

/** Where the base stands on the sheet. */
const baseOf = ({ base_mm: [x, y] }, mm) => [mm.left - y, mm.far - x];

/** What the pen reaches, row by row as the map has it: what is known of a row and of the next is joined at its ends. */
function zoneOf(arm, mm) {
  const zone = new Path2D();
  const { x_mm: xs, y_mm: ys, error_mm: error } = arm.map;
  const at = ([i, j]) => [mm.left - ys[i][j], mm.far - xs[i][j]];
  const known = error.map((row, i) => spansOf(row).map(([begin, end]) => Array.from({ length: end - begin + 1 }, (_, k) => [i, begin + k])));
  for (let i = 0; i + 1 < known.length; i++) {
    for (const one of known[i]) {
      for (const next of known[i + 1]) {
        const isBeside = one[0][1] <= next.at(-1)[1] && next[0][1] <= one.at(-1)[1];
        if (!isBeside) continue;
        [...one, ...next.toReversed()].forEach((node, k) => (k ? zone.lineTo(...at(node)) : zone.moveTo(...at(node))));
        zone.closePath();
      }
    }
  }
  return zone;
}

/** [[first, last], ...] of what is known of a row. */
function spansOf(row) {
  const spans = [];
  row.forEach((value, j) => {
    if (value === null) return;
    if (j && row[j - 1] !== null) spans.at(-1)[1] = j;
    else spans.push([j, j]);
  });
  return spans;
}

function drawBase(context, [x, y], colour, px) {
  context.fillStyle = colour("--knuckle");
  context.beginPath();
  context.arc(x, y, 5 * px + 3, 0, 2 * Math.PI);
  context.fill();
}

function drawRuler(context, { scale }, width, height, ratio, colour) {
  const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500];
  const length = steps.find((step) => step * scale > 60 * ratio) ?? 1000;
  context.setTransform(1, 0, 0, 1, 0, 0);
  const [x, y] = [12 * ratio, height - 14 * ratio];
  context.strokeStyle = context.fillStyle = colour("--ink");
  context.lineWidth = 1.5 * ratio;
  context.beginPath();
  context.moveTo(x, y - 4 * ratio);
  context.lineTo(x, y);
  context.lineTo(x + length * scale, y);
  context.lineTo(x + length * scale, y - 4 * ratio);
  context.stroke();
  context.font = `${12 * ratio}px system-ui, sans-serif`;
  context.fillText(`${length} mm`, x + 4 * ratio, y - 5 * ratio);
}
