// Positions of the joints over time, each between its limits.

const LEFT = 58;
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a5a00", "#56b4e9", "#5c6166"];

export class JointsView {
  constructor(canvas) {
    this.canvas = canvas;
    this.film = null;
    this.time = 0;
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(film) {
    this.film = film;
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
    if (!canvas.clientWidth) return;
    const ratio = devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    Object.assign(canvas, { width: width * ratio, height: height * ratio });
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    if (!film) return;
    const style = getComputedStyle(canvas);
    const [ink, quiet, line] = ["--ink", "--quiet", "--line"].map((name) => style.getPropertyValue(name).trim());
    const n = film.joints.length;
    const count = film.positions.length / n;
    const each = height / n;
    const x = (time) => LEFT + ((width - LEFT - 10) * (time - film.begin)) / (film.duration || 1);
    context.font = "12px system-ui, sans-serif";
    film.joints.forEach((joint, k) => {
      const [top, bottom] = [k * each + 8, (k + 1) * each - 8];
      const y = (value) => bottom - ((bottom - top) * (value - joint.min)) / (joint.max - joint.min || 1);
      context.strokeStyle = line;
      context.setLineDash([5, 4]);
      context.beginPath();
      for (const value of [joint.min, joint.max]) {
        context.moveTo(LEFT, y(value));
        context.lineTo(width - 10, y(value));
      }
      context.stroke();
      context.setLineDash([]);
      context.strokeStyle = COLOURS[k % COLOURS.length];
      context.lineWidth = 1.4;
      context.beginPath();
      const step = Math.max(Math.floor(count / (3 * width)), 1);
      for (let i = 0; i < count; i += step) {
        context.lineTo(x(film.begin + (i * film.every) / film.rate), y(film.positions[i * n + k]));
      }
      context.stroke();
      context.fillStyle = ink;
      context.fillText(joint.name, 8, (top + bottom) / 2);
      context.fillStyle = quiet;
      const unit = joint.unit === "deg" ? "°" : " mm";
      context.fillText(`${joint.max.toFixed(0)}${unit}`, 8, top + 8);
      context.fillText(`${joint.min.toFixed(0)}${unit}`, 8, bottom);
    });
    context.strokeStyle = ink;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x(this.time), 4);
    context.lineTo(x(this.time), height - 4);
    context.stroke();
  }
}
