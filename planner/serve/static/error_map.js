// The error of an arm over its paper, as a bitmap of coloured cells.

import { PaintedOnce } from "./painted_once.js";

const [LEAST, MOST] = [[207, 227, 241], [213, 94, 0]]; // as in the legend
const ALPHA = 0.7;

export class ErrorMap {
  /** map: of the server. */
  constructor({ x_mm: x, y_mm: y, error_mm: error }) {
    const known = error.flat().filter((value) => value !== null).sort((a, b) => a - b);
    /** From the least error to what all but the worst twentieth keep, mm. */
    this.range = known.length ? [known[0], known[Math.floor(0.95 * (known.length - 1))]] : null;
    [this.x, this.y, this.error] = [x, y, error];
    this.cells = new PaintedOnce();
  }

  /** mm: the canvas, see placement.js; the context has a matrix from its sheet to pixels. */
  draw(context, mm) {
    if (!this.range) return;
    context.save();
    context.globalAlpha = ALPHA;
    this.cells.draw(context, (cells) => this.#paint(cells, mm));
    context.restore();
  }

  #paint(context, mm) {
    const { x, y, error } = this;
    const [least, most] = this.range;
    context.lineWidth = 1 / context.getTransform().a; // over the seams
    for (let i = 0; i + 1 < x.length; i++) {
      for (let j = 0; j + 1 < x[i].length; j++) {
        const known = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].filter(([k, l]) => error[k][l] !== null);
        if (error[i][j] === null || known.length < 3) continue;
        const share = Math.min(Math.max((error[i][j] - least) / (most - least || 1), 0), 1);
        const colour = LEAST.map((channel, k) => Math.round(channel + share * (MOST[k] - channel)));
        context.fillStyle = context.strokeStyle = `rgb(${colour.join(" ")})`;
        context.beginPath();
        for (const [k, l] of known) context.lineTo(mm.left - y[k][l], mm.far - x[k][l]);
        context.fill();
        context.stroke();
      }
    }
  }
}
