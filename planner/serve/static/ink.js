// Lines as bitmaps: what is dragged about is painted once, and then only put elsewhere; what a film has drawn stays.

import { brushOf, element } from "./dom.js";

const PAD = 4;
const LARGEST = 3000;

const LIGHT = 0.7;

/** A colour of ink, darker where it could not be told from the paper. */
export function seenOnPaper(colour) {
  const channels = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(colour)?.slice(1).map((hex) => parseInt(hex, 16));
  if (!channels) return colour;
  const brightness = (0.2126 * channels[0] + 0.7152 * channels[1] + 0.0722 * channels[2]) / 255;
  if (brightness <= LIGHT) return colour;
  return `rgb(${channels.map((channel) => Math.round((channel * LIGHT) / brightness)).join(" ")})`;
}

export class Ink {
  /** lines: of the server. Paths of one colour in a row are one. */
  constructor(lines) {
    this.paths = [];
    for (const { points, colour: of } of lines.lines) {
      const colour = seenOnPaper(of);
      let last = this.paths.at(-1);
      if (last?.colour !== colour || last.count > 400) this.paths.push((last = { colour, path: new Path2D(), count: 0 }));
      last.count += points.length;
      last.path.moveTo(...points[0]);
      for (const point of points.slice(1)) last.path.lineTo(...point);
      if (points.length === 1) last.path.lineTo(points[0][0] + 1e-3, points[0][1]);
    }
  }

  /**
   * Puts the lines on a sheet. sheet: matrix from it to pixels. place: where they go on it, see placement.js. isMoving:
   * somebody turns or sizes them just now, so that a bitmap of another turn and size will do. colour: instead of their
   * own.
   */
  draw(context, sheet, place, isMoving, colour = null) {
    const { turn: [a, b, c, d], box, factor, corner } = place;
    const toSheet = new DOMMatrix([
      factor * a, factor * b, factor * c, factor * d, corner[0] - factor * box.left, corner[1] - factor * box.top,
    ]);
    const key = [a, b, c, d, factor, sheet.a].join(" ");
    if (!this.painted || (this.painted.key !== key && !isMoving)) this.#paint(key, sheet, place, toSheet);
    const { bitmap, fromPage, key: of } = this.painted;
    const put = sheet.multiply(toSheet).multiply(fromPage.inverse());
    if (of === key && Math.abs(put.a - 1) < 1e-9) [put.e, put.f] = [Math.round(put.e), Math.round(put.f)]; // sharp
    context.save();
    context.setTransform(put);
    context.drawImage(colour ? this.#tinted(colour) : bitmap, 0, 0);
    context.restore();
  }

  #paint(key, sheet, { inked, factor }, toSheet) {
    const [width, height] = [inked.right - inked.left, inked.bottom - inked.top];
    const scale = Math.min(sheet.a, LARGEST / Math.max(width, height, 1e-9));
    const bitmap = element("canvas", "", { width: scale * width + 2 * PAD, height: scale * height + 2 * PAD });
    const fromPage = new DOMMatrix().translate(PAD, PAD).scale(scale).translate(-inked.left, -inked.top).multiply(toSheet);
    const context = brushOf(bitmap);
    context.setTransform(fromPage);
    context.lineWidth = Math.max(1 / scale, 0.3) / factor;
    context.lineCap = context.lineJoin = "round";
    for (const { path, colour } of this.paths) {
      context.strokeStyle = colour;
      context.stroke(path);
    }
    this.painted = { key, bitmap, fromPage, tints: new Map() };
  }

  #tinted(colour) {
    const { bitmap, tints } = this.painted;
    if (!tints.has(colour)) {
      const tinted = element("canvas", "", { width: bitmap.width, height: bitmap.height });
      const context = brushOf(tinted);
      context.drawImage(bitmap, 0, 0);
      context.globalCompositeOperation = "source-in";
      context.fillStyle = colour;
      context.fillRect(0, 0, tinted.width, tinted.height);
      tints.set(colour, tinted);
    }
    return tints.get(colour);
  }
}

/** What a film has drawn by some time. */
export class Reel {
  constructor(film) {
    this.film = film;
  }

  /** toPixels: matrix from the arm's (x, y) to those of the context. px: mm of one. until: sample of the trajectory. */
  draw(context, toPixels, px, until) {
    const { width, height } = context.canvas;
    const { strokes } = this.film;
    const begun = strokes.findIndex(({ from }) => from > until);
    const count = begun < 0 ? strokes.length : begun;
    const key = [toPixels.toString(), width, height].join(" ");
    if (this.key !== key || this.count > count) {
      this.canvas = element("canvas", "", { width, height });
      [this.key, this.count] = [key, 0];
    }
    const reel = brushOf(this.canvas);
    reel.setTransform(toPixels);
    reel.lineCap = reel.lineJoin = "round";
    for (const { path, colour, width: of } of strokes.slice(this.count, count)) {
      reel.lineWidth = Math.max(of || 0.3, px);
      reel.strokeStyle = seenOnPaper(colour);
      reel.stroke(path);
    }
    this.count = count;
    context.save();
    context.resetTransform();
    context.drawImage(this.canvas, 0, 0);
    context.restore();
  }
}
