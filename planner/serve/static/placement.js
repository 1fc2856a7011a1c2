// Where a drawing goes on the paper, as the planner has it: see planner/placement/place.py. Lengths are mm; sheet
// points are (X, Y) to the right of and below the far left corner of the canvas, as seen from behind the arm.

const PAPERS = { a4: [210, 297], a5: [148, 210], a6: [105, 148], letter: [215.9, 279.4] };

export function canvasOf(arm) {
  const xs = arm.canvas_mm.map((corner) => corner[0]);
  const ys = arm.canvas_mm.map((corner) => corner[1]);
  const [near, far, right, left] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  return { near, far, right, left, width: left - right, height: far - near };
}

/** The matrix [a, b, c, d] that turns and mirrors page points: x' = a x + c y, y' = b x + d y. */
export function turning(rotate, mirror) {
  const angle = (rotate * Math.PI) / 180;
  const [c, s, m] = [Math.cos(angle), Math.sin(angle), mirror ? -1 : 1];
  return [m * c, m * s, -s, c];
}

export const turned = ([a, b, c, d], [x, y]) => [a * x + c * y, b * x + d * y];

export function extentOf(points) {
  const box = { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity };
  for (const [x, y] of points) {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.top = Math.min(box.top, y);
    box.bottom = Math.max(box.bottom, y);
  }
  return box;
}

/** Corners of the convex hull of points: whatever is turned, its extent is theirs. */
export function hullOf(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const isLeft = (p, q, r) => (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0;
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && !isLeft(chain.at(-2), chain.at(-1), point)) chain.pop();
      chain.push(point);
    }
    return chain;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/** The rectangle of the paper on the sheet, and what of it the canvas has. */
export function paperOf(canvas, name, isWide) {
  const whole = { left: 0, top: 0, width: canvas.width, height: canvas.height };
  if (!name) return { sheet: null, room: whole };
  const [short, long] = [...PAPERS[name]].sort((a, b) => a - b);
  const [width, height] = isWide ? [long, short] : [short, long];
  const bottom = canvas.height - Math.max(canvas.height - height, 0) / 2;
  const sheet = { left: (canvas.width - width) / 2, top: bottom - height, width, height };
  const left = Math.max(0, sheet.left);
  const top = Math.max(0, sheet.top);
  const room = {
    left,
    top,
    width: Math.min(canvas.width, sheet.left + width) - left,
    height: Math.min(canvas.height, sheet.top + height) - top,
  };
  return { sheet, room };
}

/**
 * lines: of the server, with `hull` (points of the page that its extent depends on). options: of the form. What is
 * placed, where its top left corner goes and by how much it is scaled.
 */
export function placed(lines, canvas, options) {
  const turn = turning(options.rotate, options.mirror);
  const [width, height] = lines.page_mm;
  const page = [[0, 0], [width, 0], [width, height], [0, height]];
  const ink = extentOf(lines.hull.map((point) => turned(turn, point)));
  const box = lines.has_page ? extentOf(page.map((point) => turned(turn, point))) : ink;
  const size = [box.right - box.left, box.bottom - box.top];
  const paper = paperOf(canvas, options.paper, size[0] > size[1]);
  const isFitted = options.scale === null && options.at === null;
  const margin = options.margin ?? 5;
  const cell = [paper.room.width - 2 * margin, paper.room.height - 2 * margin];
  const filling = Math.min(cell[0] / size[0], cell[1] / size[1]);
  const factor = options.scale ?? (isFitted ? (Number.isFinite(filling) ? filling : 1) : 1);
  const begin = paper.sheet ?? paper.room;
  const corner = options.at
    ? [begin.left + options.at[0], begin.top + options.at[1]]
    : [
        paper.room.left + margin + (cell[0] - factor * size[0]) / 2,
        paper.room.top + margin + (cell[1] - factor * size[1]) / 2,
      ];
  const inked = {
    left: corner[0] + factor * (ink.left - box.left),
    top: corner[1] + factor * (ink.top - box.top),
    right: corner[0] + factor * (ink.right - box.left),
    bottom: corner[1] + factor * (ink.bottom - box.top),
  };
  const kept = isFitted ? margin : 0;
  const room = paper.room;
  const over = Math.max(
    room.left + kept - inked.left,
    room.top + kept - inked.top,
    inked.right - (room.left + room.width - kept),
    inked.bottom - (room.top + room.height - kept),
  );
  return { turn, box, size, factor, corner, paper, begin, inked, over };
}
