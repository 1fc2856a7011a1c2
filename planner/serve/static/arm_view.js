// The arm in three dimensions, over its paper, with the ink that has been drawn.

import * as three from "/static/vendor/three.js";

const colourOf = (name) => new three.Color(getComputedStyle(document.body).getPropertyValue(name).trim());
const UP = new three.Vector3(0, 1, 0);

export class ArmView {
  constructor(canvas, says) {
    this.canvas = canvas;
    this.says = says;
    try {
      this.renderer = new three.WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch {
      says.textContent = "This browser shows no three dimensions; the sheet shows what is drawn.";
      return;
    }
    this.scene = new three.Scene();
    this.camera = new three.PerspectiveCamera(40, 1, 1, 10000);
    this.camera.up.set(0, 0, 1);
    this.controls = new three.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.scene.add(new three.AmbientLight(0xffffff, 1.6));
    const sun = new three.DirectionalLight(0xffffff, 2.2);
    sun.position.set(-200, 300, 600);
    this.scene.add(sun);
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(film, arm) {
    if (!this.renderer) return;
    this.film = film;
    this.world?.removeFromParent();
    if (!film) return this.draw();
    this.world = new three.Group();
    this.scene.add(this.world);
    const reach = arm?.reach_mm?.[1] ?? 300;
    this.#addPaper(arm, reach);
    this.#addInk(film);
    this.#addLinks(film, arm, reach);
    const middle = arm?.canvas_mm ? (arm.canvas_mm[0][0] + arm.canvas_mm[2][0]) / 2 : reach / 2;
    if (this.shown !== arm?.name) {
      this.shown = arm?.name;
      this.controls.target.set(0.6 * middle, 0, 0.15 * reach);
      this.camera.position.set(-1.5 * reach, -1.2 * reach, 1.3 * reach);
      this.controls.update();
    }
    this.at(film.begin, 0);
  }

  #addPaper(arm, reach) {
    const corners = arm?.canvas_mm ?? [[reach, reach], [reach, -reach], [0, -reach], [0, reach]];
    const xs = corners.map(([x]) => x);
    const ys = corners.map(([, y]) => y);
    const [width, height] = [Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)];
    const paper = new three.Mesh(
      new three.PlaneGeometry(width, height),
      new three.MeshBasicMaterial({ color: colourOf("--paper"), side: three.DoubleSide }),
    );
    paper.position.set((Math.max(...xs) + Math.min(...xs)) / 2, (Math.max(...ys) + Math.min(...ys)) / 2, -0.2);
    this.world.add(paper);
    const grid = new three.GridHelper(4 * reach, 40, colourOf("--line"), colourOf("--line"));
    grid.rotation.x = Math.PI / 2;
    grid.position.z = -0.6;
    this.world.add(grid);
  }

  #addInk(film) {
    const [points, colours, samples] = [[], [], []];
    const colour = new three.Color();
    for (const stroke of film.strokes) {
      colour.set(stroke.colour);
      const list = stroke.points.length === 1 ? [stroke.points[0], [stroke.points[0][0] + 0.4, ...stroke.points[0].slice(1)]] : stroke.points;
      for (let k = 0; k + 1 < list.length; k++) {
        points.push(list[k][0], list[k][1], 0, list[k + 1][0], list[k + 1][1], 0);
        colours.push(colour.r, colour.g, colour.b, colour.r, colour.g, colour.b);
        samples.push(list[k + 1][2]);
      }
    }
    const ink = new three.BufferGeometry();
    ink.setAttribute("position", new three.BufferAttribute(new Float32Array(points), 3));
    ink.setAttribute("color", new three.BufferAttribute(new Float32Array(colours), 3));
    this.ink = ink;
    this.samples = samples;
    this.world.add(new three.LineSegments(ink, new three.LineBasicMaterial({ vertexColors: true })));
  }

  #addLinks(film, arm, reach) {
    const material = new three.MeshStandardMaterial({ color: colourOf("--link"), roughness: 0.55, metalness: 0.15 });
    const pen = new three.MeshStandardMaterial({ color: colourOf("--accent"), roughness: 0.4 });
    const first = film.nodesAt(film.begin);
    const isLink = (_, k) => Math.hypot(...[0, 1, 2].map((axis) => first[k + 1][axis] - first[k][axis])) > 0.5;
    const last = first.slice(0, -1).findLastIndex(isLink); // which holds the pen
    this.links = Array.from({ length: film.nodes - 1 }, (_, k) => {
      const thickness = arm?.joints?.[k]?.thickness_mm ?? 0.05 * reach;
      const radius = k === last ? 0.012 * reach : Math.max(thickness / 2, 0.008 * reach);
      const link = new three.Mesh(new three.CylinderGeometry(k === last ? radius * 0.35 : radius, radius, 1, 20), k === last ? pen : material);
      this.world.add(link);
      return link;
    });
    this.knuckles = Array.from({ length: film.nodes - 1 }, (_, k) => {
      const thickness = arm?.joints?.[k]?.thickness_mm ?? 0.05 * reach;
      const knuckle = new three.Mesh(new three.SphereGeometry(k === last ? 0.014 * reach : 0.62 * thickness, 20, 14), material);
      this.world.add(knuckle);
      return knuckle;
    });
  }

  /** The arm at a time, with the ink up to a sample. */
  at(time, sample) {
    if (!this.renderer || !this.film) return;
    const nodes = this.film.nodesAt(time).map((node) => new three.Vector3(...node));
    this.links.forEach((link, k) => {
      const along = nodes[k + 1].clone().sub(nodes[k]);
      const length = along.length();
      link.visible = length > 0.5;
      if (!link.visible) return;
      link.position.copy(nodes[k]).addScaledVector(along, 0.5);
      link.scale.y = length;
      link.quaternion.setFromUnitVectors(UP, along.normalize());
    });
    this.knuckles.forEach((knuckle, k) => knuckle.position.copy(nodes[k]));
    let [low, high] = [0, this.samples.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.samples[middle] <= sample) low = middle + 1;
      else high = middle;
    }
    this.ink.setDrawRange(0, 2 * low);
    this.draw();
  }

  draw() {
    if (!this.renderer) return;
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(() => {
      const { clientWidth: width, clientHeight: height } = this.canvas;
      if (!width) return;
      this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.renderer.render(this.scene, this.camera);
    });
  }
}
