// The arm in three dimensions as it stands in the world, with its paper and the ink that has been drawn.

import * as three from "/static/vendor/three.js";
import { seenOnPaper } from "./ink.js";

const colourOf = (name) => new three.Color(getComputedStyle(document.body).getPropertyValue(name).trim());
const [UP, VERTICAL] = [new three.Vector3(0, 1, 0), new three.Vector3(0, 0, 1)];
const LYING = 0.7; // least cosine of the tilt of a paper that lies rather than stands
const POSES = 24; // that have to be in sight
const TURN = Math.PI / 36;

export class ArmView {
  constructor(canvas, says) {
    this.canvas = canvas;
    try {
      this.renderer = new three.WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch {
      says.textContent = "This browser shows no three dimensions; the sheet shows what is drawn.";
      return;
    }
    this.scene = new three.Scene();
    this.camera = new three.PerspectiveCamera(32, 1, 1, 10000);
    this.camera.up.copy(VERTICAL);
    this.controls = new three.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.isFitted = true));
    this.scene.add(new three.AmbientLight(0xffffff, 1.5));
    for (const [power, ...from] of [[2.2, -200, 300, 600], [0.9, 300, -400, 150]]) {
      const light = new three.DirectionalLight(0xffffff, power);
      light.position.set(...from);
      this.scene.add(light);
    }
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.show(this.film, this.arm));
    canvas.addEventListener("keydown", (event) => this.#key(event));
  }

  /** film, arm: of the server; null for none. */
  show(film, arm) {
    if (!this.renderer) return;
    const [time, sample] = this.shownAt ?? [film?.begin, 0];
    [this.film, this.arm] = [film, arm];
    this.world?.removeFromParent();
    if (!film) {
      this.shownAt = null;
      return this.draw();
    }
    this.world = new three.Group();
    this.scene.add(this.world);
    this.fromPaper = new three.Matrix4().set(...film.T_base_paper.flat());
    this.onPaper = new three.Group();
    this.onPaper.applyMatrix4(this.fromPaper);
    this.world.add(this.onPaper);
    const reach = arm?.reach_mm?.[1] ?? 300;
    this.#addPaper(film, reach);
    this.#addInk(film, reach);
    this.#addArm(film, reach);
    if (this.fittedTo !== film.arm) [this.fittedTo, this.isFitted] = [film.arm, false];
    this.at(time, sample);
  }

  /** All that is to be in sight, in the base frame. */
  #inSight(film) {
    const poses = Array.from({ length: POSES }, (_, k) => film.nodesAt(film.begin + (film.duration * k) / (POSES - 1))).flat();
    return [...film.paper.map(([x, y]) => [x, y, 0]), ...poses].map((point) => new three.Vector3(...point).applyMatrix4(this.fromPaper));
  }

  #addPaper(film, reach) {
    const [[near, right], , [far, left]] = film.paper;
    const thickness = 0.006 * reach;
    const paper = new three.Mesh(
      new three.BoxGeometry(far - near, left - right, thickness),
      [0, 1, 2, 3, 4, 5].map((side) => new three.MeshBasicMaterial({ color: colourOf(side === 4 ? "--paper" : "--board") })),
    );
    paper.position.set((near + far) / 2, (left + right) / 2, -thickness / 2);
    this.onPaper.add(paper);
  }

  #addInk(film, reach) {
    const [points, colours, samples] = [[], [], []];
    const [colour, above] = [new three.Color(), 0.0015 * reach];
    for (const stroke of film.strokes) {
      colour.set(seenOnPaper(stroke.colour));
      const [first] = stroke.points;
      const list = stroke.points.length === 1 ? [first, [first[0] + 0.4, ...first.slice(1)]] : stroke.points;
      for (let k = 0; k + 1 < list.length; k++) {
        points.push(list[k][0], list[k][1], above, list[k + 1][0], list[k + 1][1], above);
        colours.push(colour.r, colour.g, colour.b, colour.r, colour.g, colour.b);
        samples.push(list[k + 1][2]);
      }
    }
    this.ink = new three.BufferGeometry();
    this.ink.setAttribute("position", new three.BufferAttribute(new Float32Array(points), 3));
    this.ink.setAttribute("color", new three.BufferAttribute(new Float32Array(colours), 3));
    this.inked = samples;
    this.onPaper.add(new three.LineSegments(this.ink, new three.LineBasicMaterial({ vertexColors: true })));
  }

  #addArm(film, reach) {
    const metal = new three.MeshStandardMaterial({ color: colourOf("--link"), roughness: 0.5, metalness: 0.1 });
    const dark = new three.MeshStandardMaterial({ color: colourOf("--knuckle"), roughness: 0.6, metalness: 0.1 });
    const pen = (this.body = new three.MeshStandardMaterial({ roughness: 0.4 }));
    const rod = (bottom, top, material) => {
      const mesh = new three.Mesh(new three.CylinderGeometry(top, bottom, 1, 24), material);
      this.onPaper.add(mesh);
      return mesh;
    };
    const half = film.thicknesses_mm.map((thickness) => Math.max((thickness ?? 0.05 * reach) / 2, 0.006 * reach));
    this.links = half.map((radius) => rod(radius, radius, metal));
    this.knuckles = half.slice(1).map((radius) => {
      const knuckle = new three.Mesh(new three.SphereGeometry(1.2 * radius, 24, 16), dark);
      this.onPaper.add(knuckle);
      return knuckle;
    });
    this.penLength = 0.2 * reach;
    this.pen = [rod(0.011 * reach, 0.011 * reach, pen), rod(0.0015 * reach, 0.011 * reach, pen)];
    this.#addFloor(film, reach, dark);
  }

  /** The floor that the base stands on: by a column, where anything comes lower than the base. */
  #addFloor(film, reach, material) {
    const lowest = Math.min(0, ...this.#inSight(film).map(({ z }) => z));
    const height = 0.03 * reach - lowest;
    const column = new three.Mesh(new three.CylinderGeometry(0.06 * reach, 0.075 * reach, height, 40), material);
    column.rotation.x = Math.PI / 2;
    column.position.z = lowest + height / 2;
    this.world.add(column);
    const cell = [10, 20, 50, 100, 200, 500].find((length) => 8 * length > reach) ?? 1000;
    const floor = new three.GridHelper(24 * cell, 24, colourOf("--grid"), colourOf("--grid"));
    floor.rotation.x = Math.PI / 2;
    floor.position.z = lowest - 0.01 * reach;
    this.world.add(floor);
  }

  /** The camera on the side of the paper that is drawn on, as far away as it has to be. */
  #fit() {
    const [x, y, z] = [0, 1, 2].map((axis) => this.film.T_base_paper[axis][2]); // out of the paper
    const away = new three.Vector3(-0.66, -0.52, z < -LYING ? -0.02 : 0.54);
    if (Math.abs(z) <= LYING) {
      const level = new three.Vector3(x, y, 0).normalize();
      away.copy(level).addScaledVector(new three.Vector3(-level.y, level.x, 0), 0.7).addScaledVector(VERTICAL, 0.35 + 0.4 * z);
    }
    away.normalize();
    const points = this.#inSight(this.film);
    const [low, high] = [points[0].clone(), points[0].clone()];
    for (const point of points) low.min(point), high.max(point);
    low.min(new three.Vector3());
    high.max(new three.Vector3());
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const across = new three.Vector3().crossVectors(VERTICAL, away).normalize();
    const upwards = new three.Vector3().crossVectors(away, across);
    const slope = Math.tan((this.camera.fov * Math.PI) / 360);
    const farEnough = (point) => {
      const from = point.clone().sub(middle);
      return from.dot(away) + Math.max(Math.abs(from.dot(across)) / this.camera.aspect, Math.abs(from.dot(upwards))) / slope;
    };
    const distance = 1.12 * Math.max(...[new three.Vector3(), ...points].map(farEnough));
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(away, distance);
    [this.camera.near, this.camera.far] = [0.02 * distance, 12 * distance];
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** The arm at a time, with the ink up to a sample. */
  at(time, sample) {
    if (!this.renderer || !this.film) return;
    this.shownAt = [time, sample];
    const nodes = this.film.nodesAt(time).map((node) => new three.Vector3(...node));
    const [wrist, tip] = nodes.slice(-2);
    const pen = wrist.clone().sub(tip);
    const share = Math.min(this.penLength / Math.max(pen.length(), 1e-6), 1);
    const held = tip.clone().addScaledVector(pen, share);
    this.links.forEach((link, k) => this.#span(link, nodes[k], k === this.links.length - 1 ? held : nodes[k + 1]));
    const nib = tip.clone().addScaledVector(pen, 0.3 * share);
    this.#span(this.pen[0], nib, held);
    this.#span(this.pen[1], tip, nib);
    const inserted = this.film.pens[this.film.pen_changes.filter((change) => change <= sample).length];
    this.body.color.set(inserted ? inserted.colour : colourOf("--accent"));
    this.knuckles.forEach((knuckle, k) => knuckle.position.copy(nodes[k + 1]));
    let [low, high] = [0, this.inked.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.inked[middle] <= sample) low = middle + 1;
      else high = middle;
    }
    this.ink.setDrawRange(0, 2 * low);
    this.draw();
  }

  #span(rod, from, to) {
    const along = to.clone().sub(from);
    const length = along.length();
    rod.visible = length > 0.5;
    if (!rod.visible) return;
    rod.position.copy(from).addScaledVector(along, 0.5);
    rod.scale.y = length;
    rod.quaternion.setFromUnitVectors(UP, along.normalize());
  }

  #key(event) {
    if (!this.film) return;
    const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { "+": 1 / 1.1, "=": 1 / 1.1, "-": 1.1 }[event.key];
    const from = this.camera.position.clone().sub(this.controls.target);
    this.isFitted = true;
    if (turn) {
      const [distance, around] = [from.length(), Math.atan2(from.y, from.x) + TURN * turn[0]];
      const down = Math.min(Math.max(Math.acos(from.z / distance) + TURN * turn[1], 0.05), Math.PI - 0.05);
      from.set(Math.sin(down) * Math.cos(around), Math.sin(down) * Math.sin(around), Math.cos(down)).multiplyScalar(distance);
    } else if (zoom) from.multiplyScalar(zoom);
    else if (event.key === "f") this.isFitted = false;
    else return;
    this.camera.position.copy(this.controls.target).add(from);
    this.controls.update();
    this.draw();
    event.preventDefault();
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
      if (this.film && !this.isFitted) this.#fit();
      this.renderer.render(this.scene, this.camera);
    });
  }
}
