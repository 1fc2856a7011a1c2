// A planned motion, unpacked: poses of the links, what the pen draws, and the joints.

const BLUE = "#0072b2";

function numbers(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Kind(bytes.buffer);
}

export function unpacked(film) {
  const poses = Float32Array.from(numbers(film.poses, Int16Array), (value) => value * film.scale);
  const line = Float32Array.from(numbers(film.line, Int16Array), (value) => value * film.scale);
  const samples = numbers(film.samples, Uint32Array);
  const begins = numbers(film.begins, Uint8Array);
  const nPoses = poses.length / (3 * film.nodes);
  const positions = numbers(film.positions, Float32Array);
  const isAlone = film.pens.length === 0;
  const penAt = (sample) => film.pen_changes.filter((change) => change <= sample).length;
  const penOf = (sample) => (isAlone ? { colour: BLUE, width_mm: 0 } : film.pens[penAt(sample)]);
  const strokes = [];
  for (let k = 0; k < samples.length; k++) {
    if (begins[k]) {
      const pen = penOf(samples[k]);
      strokes.push({ path: new Path2D(), from: samples[k], colour: pen.colour, width: pen.width_mm, points: [] });
      strokes.at(-1).path.moveTo(line[2 * k], line[2 * k + 1]);
    } else strokes.at(-1).path.lineTo(line[2 * k], line[2 * k + 1]);
    strokes.at(-1).points.push([line[2 * k], line[2 * k + 1], samples[k]]);
  }
  for (const stroke of strokes) {
    if (stroke.points.length === 1) stroke.path.lineTo(stroke.points[0][0] + 1e-3, stroke.points[0][1]);
  }
  return {
    ...film,
    strokes,
    positions,
    duration: film.end - film.begin,
    /** Nodes of the links at a time, [[x, y, z], ...] in the frame of the paper. */
    nodesAt(time) {
      const at = Math.min(Math.max(((time - film.begin) / (film.end - film.begin || 1)) * (nPoses - 1), 0), nPoses - 1);
      const before = Math.min(Math.floor(at), Math.max(nPoses - 2, 0));
      const share = at - before;
      const next = Math.min(before + 1, nPoses - 1);
      return Array.from({ length: film.nodes }, (_, node) =>
        [0, 1, 2].map((axis) => {
          const index = (pose) => poses[(pose * film.nodes + node) * 3 + axis];
          return (1 - share) * index(before) + share * index(next);
        }),
      );
    },
  };
}
