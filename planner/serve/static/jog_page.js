// The page that moves one joint at a time, and what is found by it.

import { post } from "./api.js";
import { $, element, item, offer, say, tried } from "./dom.js";

const OF_A_JOINT = [
  ["reverse", "Turns the wrong way"],
  ["zero", "Stands at zero"],
  ["low", "Lower limit"],
  ["high", "Upper limit"],
];

export class JogPage {
  constructor() {
    this.jog = null;
    $("jog-begin").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#tried(() => post("/api/jog", {
        arm: $("jog-arm").value, target: $("jog-target").value, driver: $("jog-driver").value,
        port: this.simulators.includes($("jog-driver").value) ? "" : $("jog-port").value,
        "from-middle": $("jog-from-middle").checked,
      }));
    });
    $("jog-arm").addEventListener("change", () => this.#name());
    for (const button of document.querySelectorAll("[data-jog]")) {
      const command = button.dataset.jog;
      button.addEventListener("click", () => this.#do(command, command === "card" ? { number: Number($("jog-card").value) } : {}));
    }
  }

  get runs() {
    return this.jog !== null && this.jog.stand !== "idle";
  }

  offer(arms, drivers, simulators) {
    this.simulators = simulators;
    offer($("jog-arm"), arms);
    offer($("jog-driver"), drivers.filter((name) => name !== "mujoco"));
    if (!$("jog-target").value) this.#name();
  }

  show(jog) {
    this.jog = jog;
    const { runs } = this;
    $("jog-begin").hidden = runs;
    $("jog-box").hidden = !runs;
    const unsaved = jog.saved ? "" : " What was found is not saved yet.";
    const text = jog.refused || (runs ? `${jog.arm}: ${jog.stand}.${unsaved}` : jog.ended);
    say($("jog-says"), text, jog.refused ? "bad" : "");
    $("jog-lines").replaceChildren(...(runs ? [] : jog.lines).map(item));
    $("jog-command").textContent = jog.command;
    if (jog.pen_mm.length) {
      const [x, y, height] = jog.pen_mm.map((value) => value.toFixed(1));
      $("jog-pen").textContent = `${x} mm away from the base, ${y} mm to its left, ${height} mm over the paper`;
    }
    const rows = $("jog-joints").children;
    if (rows.length !== jog.joints.length || [...rows].some((row, k) => row.dataset.joint !== jog.joints[k].name)) {
      $("jog-joints").replaceChildren(...jog.joints.map((joint) => this.#row(joint)));
    }
    jog.joints.forEach((joint, k) => this.#fill(rows[k], joint));
  }

  #name() {
    const arm = $("jog-arm").value;
    $("jog-target").value = arm.startsWith("my_") ? arm : `my_${arm}`;
  }

  #row(joint) {
    const row = Object.assign(element("li"), { className: "joint" });
    row.dataset.joint = joint.name;
    const buttons = [["move", "−", -1], ["move", "+", 1], ...OF_A_JOINT].map(([command, text, sign]) => {
      const button = element("button", text, { type: "button" });
      button.setAttribute("aria-label", `${joint.name}: ${sign ? (sign < 0 ? "less" : "more") : text.toLowerCase()}`);
      const number = () => (command === "move" ? sign * Number($("jog-step").value) : 0);
      button.addEventListener("click", () => this.#do(command, { joint: joint.name, number: number() }));
      return button;
    });
    const range = element("meter", "", { className: "range" });
    row.append(element("strong", joint.name), element("span", "", { className: "at" }), range, ...buttons);
    return row;
  }

  #fill(row, joint) {
    const unit = joint.unit === "deg" ? "°" : " mm";
    const [at, low, high] = [joint.at, joint.min, joint.max].map((value) => `${value.toFixed(1).replace("-", "−")}${unit}`);
    row.querySelector(".at").textContent = `${at} (${low} to ${high}), ${joint.told.toFixed(0)} ${joint.told_unit.replace("us", "µs")}`;
    const range = row.querySelector("meter");
    Object.assign(range, { min: joint.min, max: joint.max, value: joint.at });
    range.setAttribute("aria-label", `${joint.name}: ${at}`);
  }

  #do(command, more) {
    return this.#tried(() => post("/api/jog/do", { command, ...more }));
  }

  #tried(work) {
    return tried($("jog-says"), work);
  }
}
