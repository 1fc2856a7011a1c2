// A film of planner/plots/player.py, unpacked: shared by the player and by the page of `plan serve`.

export function unpacked(film) {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const poses = new Int16Array(bytes(film.poses)), line = new Int16Array(bytes(film.line));
  const samples = new Uint32Array(bytes(film.samples)), nPoses = poses.length / (3 * film.nodes);
  return {
    ...film,
    samples, // of the trajectory, of each point that is drawn
    begins: new Uint8Array(bytes(film.begins)), // whether a line begins with it
    penOf: new Uint16Array(bytes(film.pen)), // which of film.inks draws it
    /** [x, y] of a point that is drawn, mm in the frame of the paper. */
    pointAt: (k) => [line[2 * k] * film.scale, line[2 * k + 1] * film.scale],
    /** How many points are drawn by a sample. */
    drawnBy(sample) {
      let low = 0, high = samples.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (samples[middle] <= sample) low = middle + 1; else high = middle;
      }
      return low;
    },
    /** Corners of the arm at a time, [[x, y, z], ...] in mm in the frame of the paper. */
    nodesAt(time) {
      const share = film.end > film.begin ? (time - film.begin) / (film.end - film.begin) : 0;
      const at = Math.min(Math.max(share, 0), 1) * (nPoses - 1), before = Math.min(Math.floor(at), nPoses - 2), rest = at - before;
      return Array.from({ length: film.nodes }, (_, node) => {
        const here = 3 * (before * film.nodes + node), next = here + 3 * film.nodes;
        return [0, 1, 2].map((axis) => film.scale * ((1 - rest) * poses[here + axis] + rest * poses[next + axis]));
      });
    },
  };
}
