// Which layers of a drawing are drawn, and the pens that draw them.

import { element } from "./dom.js";
import { hullOf } from "./placement.js";

const UNNAMED = "(no layer)";

export class Layers {
  /** changed: called when somebody chooses. */
  constructor(box, changed) {
    this.box = box;
    this.changed = changed;
    this.names = [];
  }

  /** lines: of the server. value: as the option --layers has it, "" for those that are usually drawn. */
  show(lines, value) {
    const colours = new Map();
    for (const { layer, colour } of lines?.lines ?? []) {
      if (!colours.has(layer)) colours.set(layer, new Set());
      colours.get(layer).add(colour);
    }
    this.names = [...colours.keys()];
    // names with a comma, or a blank at an end, cannot be said in a list
    const canChoose = this.names.length > 1 && this.names.every((name) => name === name.trim() && !name.includes(","));
    this.box.hidden = !canChoose;
    this.boxes = this.names.map((name) => {
      const isChosen = value ? value.split(",").includes(name) : this.#isUsual(name);
      const input = Object.assign(document.createElement("input"), { type: "checkbox", checked: isChosen, disabled: !name });
      input.addEventListener("input", (event) => {
        event.stopPropagation();
        this.#choose(input);
      });
      return input;
    });
    this.box.querySelector("ul").replaceChildren(...this.names.map((name, k) => {
      const label = element("label", "", { className: "inline" });
      label.append(this.boxes[k], ...[...colours.get(name)].slice(0, 6).map(swatch), name || UNNAMED);
      const row = element("li");
      row.append(label);
      return row;
    }));
  }

  /** As the option --layers has it. */
  get value() {
    const chosen = this.#chosen();
    const isUsual = this.names.every((name) => chosen.has(name) === this.#isUsual(name));
    return isUsual || this.box.hidden ? "" : [...chosen].join(",");
  }

  /** What is left of the lines. */
  of(lines) {
    if (!lines) return null;
    const chosen = this.#chosen();
    const left = lines.lines.filter(({ layer }) => chosen.has(layer));
    return { ...lines, lines: left, hull: hullOf(left.flatMap((line) => line.points)) };
  }

  #isUsual(name) {
    return !name.trimStart().startsWith("%");
  }

  #chosen() {
    return new Set(this.names.filter((_, k) => this.boxes[k].checked));
  }

  #choose(input) {
    if (!this.boxes.some((box) => box.checked)) input.checked = true; // something has to be drawn
    this.names.forEach((name, k) => {
      if (!name) this.boxes[k].checked = this.names.every((other, l) => !other || this.boxes[l].checked === this.#isUsual(other));
    });
    this.changed();
  }
}

export function swatch(colour) {
  const found = element("span", "", { className: "swatch" });
  found.style.background = colour;
  return found;
}

/** The pens of a film, in a list. */
export function showPens(list, pens) {
  list.hidden = !pens.length;
  list.replaceChildren(...pens.map(({ name, colour, width_mm: width }) => {
    const row = element("li");
    row.append(swatch(colour), width ? `${name}, ${width} mm` : name);
    return row;
  }));
}
