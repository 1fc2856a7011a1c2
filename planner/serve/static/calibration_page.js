// The calibration walk: pattern, drawing, photo, and what comes of it.

import { post, upload } from "./api.js";
import { $, element, item, offer, say, tried } from "./dom.js";

const WORKS = { pattern: "making the pattern", measure: "reading the photo", calibrate: "finding out how the arm is" };
const STEPS = ["pattern", "drawn", "measure", "calibrate"];

export class CalibrationPage {
  constructor() {
    $("walk-begin").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#ask("/api/calibration", { arm: $("walk-arm").value, count: Number($("walk-count").value) });
    });
    $("walk-draw").addEventListener("click", () => {
      const driver = $("walk-driver").value;
      const port = this.simulators.includes(driver) ? "" : $("walk-port").value;
      tried($("walk-says"), () => post("/api/calibration/run", { driver, port, fast: this.simulators.includes(driver) }));
    });
    for (const id of ["walk-camera", "walk-photo"]) {
      $(id).addEventListener("change", (event) => {
        const [file] = event.target.files;
        event.target.value = "";
        const bar = $("walk-bar").value.trim();
        if (file) tried($("walk-says"), () => upload(file, "/api/calibration/photo", { bar }));
      });
    }
    $("walk-calibrate").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#ask("/api/calibration/calibrate", { target: $("walk-target").value });
    });
  }

  offer(arms, drivers, simulators) {
    this.simulators = simulators;
    offer($("walk-arm"), arms);
    offer($("walk-driver"), drivers);
  }

  show(walk) {
    const busy = WORKS[walk.busy];
    say($("walk-says"), walk.error || (busy ? `${busy} …` : ""), walk.error ? "bad" : "");
    const begun = walk.has.includes("pattern");
    const done = { pattern: begun, drawn: walk.has.includes("drawn"), measure: walk.has.includes("measure"), calibrate: walk.has.includes("calibrate") };
    STEPS.forEach((step, k) => {
      const place = $(`step-${step}`);
      place.classList.toggle("done", done[step]);
      const isOpen = k === 0 || done[STEPS[k - 1]];
      for (const input of place.querySelectorAll("button, input, select")) input.disabled = !isOpen || Boolean(walk.busy);
      place.querySelector(".said")?.replaceChildren(...(walk.said[step] ?? []).map(item));
      const code = place.querySelector("pre");
      if (code) {
        code.hidden = !walk.commands[step];
        code.firstChild.textContent = walk.commands[step] ?? "";
      }
    });
    $("walk-sheet").hidden = !begun;
    $("walk-drawn").textContent = walk.drawn ? `The run of the pattern: ${walk.drawn}.` : "";
    $("walk-vision").hidden = walk.reads_photos;
    const picture = $("walk-reading");
    picture.hidden = !done.measure;
    if (done.measure && picture.dataset.reading !== String(walk.readings)) {
      picture.dataset.reading = walk.readings;
      picture.src = `/api/calibration/reading?${walk.readings}`;
    }
    if (begun && this.arm !== walk.arm) {
      this.arm = walk.arm;
      $("walk-arm").value = walk.arm;
      $("walk-target").value = walk.target || `${walk.arm.replace(/^my_/, "")}_calibrated`;
    }
    this.#showFound(walk);
  }

  #showFound({ found, target }) {
    $("walk-parameters").hidden = !found;
    $("walk-found").textContent = "";
    if (!found) return;
    const [low, high] = found.predicted_rms_interval_mm.map((value) => value.toFixed(2));
    const off = `A drawing is going to be off by ${found.predicted_rms_mm.toFixed(2)} mm (${low} to ${high}).`;
    $("walk-found").textContent = `${target} is an arm now, and can be chosen everywhere. ${off}`;
    $("walk-parameters").querySelector("tbody").replaceChildren(
      ...Object.entries(found.parameters).map(([name, { value, sd, unit }]) => {
        const row = element("tr");
        row.append(...[name, value.toFixed(3), sd.toFixed(3), unit].map((text) => element("td", text)));
        return row;
      }),
    );
  }

  #ask(path, asked) {
    return tried($("walk-says"), () => post(path, asked));
  }
}
