// What takes long to paint and stays as it is, kept as a bitmap for as long as it is seen from the same place.

import { brushOf, element } from "./dom.js";

export class PaintedOnce {
  /** paint: of a context with the same matrix; look: says what else its picture depends on. */
  draw(context, paint, look = "") {
    const matrix = context.getTransform();
    const { width, height } = context.canvas;
    const key = [matrix.toString(), width, height, look].join(" ");
    if (this.key !== key) {
      this.key = key;
      this.bitmap = element("canvas", "", { width, height });
      const brush = brushOf(this.bitmap);
      brush.setTransform(matrix);
      paint(brush);
    }
    context.save();
    context.resetTransform();
    context.drawImage(this.bitmap, 0, 0);
    context.restore();
  }
}
