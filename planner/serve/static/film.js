// A planned motion as the page shows it: what the pen draws, stroke by stroke, and the joints.

import { unpacked as read } from "./film_reader.js";

export function unpacked(told) {
  const film = read(told);
  const bytes = Uint8Array.from(atob(film.positions), (letter) => letter.charCodeAt(0));
  const strokes = [];
  film.samples.forEach((sample, k) => {
    const [x, y] = film.pointAt(k);
    if (film.begins[k]) {
      const [colour, width] = film.inks[film.penOf[k]];
      strokes.push({ path: new Path2D(), from: sample, colour, width, points: [] });
      strokes.at(-1).path.moveTo(x, y);
    } else strokes.at(-1).path.lineTo(x, y);
    strokes.at(-1).points.push([x, y, sample]);
  });
  for (const { points: [[x, y], ...more], path } of strokes) if (!more.length) path.lineTo(x + 1e-3, y);
  return { ...film, strokes, positions: new Float32Array(bytes.buffer), duration: film.end - film.begin };
}
