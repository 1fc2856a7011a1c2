// The error of an arm over its paper, as a bitmap of coloured cells.

import { brushOf, element } from "./dom.js";

const [LEAST, MOST] = [[207, 227, 241], [213, 94, 0]]; // as in the legend
const ALPHA = 0.7;

export class ErrorMap {
  /** map: of the server. */
  constructor({ x_mm: x, y_mm: y, error_mm: error }) {
    const known = error.flat().filter((value) => value !== null).sort((a, b) => a - b);
    /** From the least error to what all but the worst twentieth keep, mm. */
    this.range = known.length ? [known[0], known[Math.floor(0.95 * (known.length - 1))]] : null;
    [this.x, this.y, this.error] = [x, y, error];
  }

  /** mm: the canvas, see placement.js; the context has a matrix from its sheet to pixels. */
  draw(context, mm) {
    if (!this.range) return;
    const matrix = context.getTransform();
    const { width, height } = context.canvas;
    const key = [matrix.toString(), width, height].join(" ");
    if (this.key !== key) {
      this.key = key;
      this.bitmap = element("canvas", "", { width, height });
      const cells = brushOf(this.bitmap);
      cells.setTransform(matrix);
      cells.lineWidth = 1 / matrix.a; // over the seams
      this.#paint(cells, mm);
    }
    context.save();
    context.resetTransform();
    context.globalAlpha = ALPHA;
    context.drawImage(this.bitmap, 0, 0);
    context.restore();
  }

  #paint(context, mm) {
    const { x, y, error } = this;
    const [least, most] = this.range;
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
