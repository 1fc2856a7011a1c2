// The page: what it knows, and how its parts hang together. All that matters lives in the server.

import { get, post, remove, upload, watch } from "./api.js";
import { ArmView } from "./arm_view.js";
import { CalibrationPage } from "./calibration_page.js";
import { $, copyable, element, item, offer, say, tried } from "./dom.js";
import { unpacked } from "./film.js";
import { JogPage } from "./jog_page.js";
import { JointsView } from "./joints_view.js";
import { Layers, showPens } from "./layers.js";
import { Sheet } from "./sheet.js";

const form = $("options");
const field = (name) => form.elements[name];
const NUMBERS = ["margin", "rotate", "fill-spacing", "passes", "tolerance", "speed", "lift", "join", "rate", "image-line", "image-detail", "image-levels"];
const CHOICES = ["paper", "by", "fill", "text", "method", "image"];
const SWITCHES = ["mirror", "skip-unreachable"];

const jobs = new Map();
const arms = new Map();
const lines = new Map();
let [current, run, film, filmOf, linesOf] = [null, null, null, null, null];
let [time, plays, last] = [0, false, 0];
let isStale = false; // whether options have changed since the current drawing was planned
let commandSoon = 0;

const sheet = new Sheet($("sheet"), (moved) => {
  field("at-x").value = moved ? moved.at[0] : "";
  field("at-y").value = moved ? moved.at[1] : "";
  field("scale").value = moved ? Number((100 * moved.scale).toFixed(3)) : "";
  field("rotate").value = moved ? moved.rotate : 0;
  placeChanged();
});
const layers = new Layers($("layers"), () => {
  sheet.show({ lines: layers.of(lines.get(current)) });
  placeChanged();
});
const armView = new ArmView($("arm-view"), $("arm-says"));
const jointsView = new JointsView($("joints-view"), $("joints-table"));
const jogPage = new JogPage();
const calibrationPage = new CalibrationPage();

// -- options --------------------------------------------------------------------------------------------------------

const numberIn = (name) => (field(name).value === "" ? null : Number(field(name).value));

function placement() {
  const [x, y] = [numberIn("at-x"), numberIn("at-y")];
  const scale = numberIn("scale");
  return {
    paper: field("paper").value,
    margin: numberIn("margin"),
    rotate: numberIn("rotate") ?? 0,
    mirror: field("mirror").checked,
    at: x === null && y === null ? null : [x ?? 0, y ?? 0],
    scale: scale === null ? null : scale / 100,
  };
}

/** As the command line has them. */
function asked() {
  const found = { arm: $("arm").value };
  const { at, scale } = placement();
  if (at) found.at = at;
  if (scale !== null) found.scale = scale;
  for (const name of NUMBERS) {
    const value = numberIn(name);
    if (value !== null && !(name === "rotate" && value === 0)) found[name] = value;
  }
  if (layers.value) found.layers = layers.value;
  for (const name of CHOICES) if (field(name).value) found[name] = field(name).value;
  for (const name of SWITCHES) if (field(name).checked) found[name] = true;
  return found;
}

function showOptions(options) {
  for (const name of [...NUMBERS, ...CHOICES, "at-x", "at-y", "scale"]) field(name).value = name === "rotate" ? 0 : "";
  isStale = false;
  if (options.arm) $("arm").value = options.arm;
  if (options.at) [field("at-x").value, field("at-y").value] = options.at;
  if (options.scale) field("scale").value = Number((100 * options.scale).toFixed(3));
  for (const name of [...NUMBERS, ...CHOICES]) if (options[name] !== undefined) field(name).value = options[name];
  for (const name of SWITCHES) field(name).checked = Boolean(options[name]);
}

function placeChanged() {
  forgetFilm();
  isStale = Boolean(jobs.get(current)?.command);
  showWhatCanRun();
  sheet.show({ options: placement() });
  sayPlace();
  sayCommand();
}

/** As it was when it was planned. */
async function unchange() {
  const job = jobs.get(current);
  showAsked(job);
  showJob(job);
  await showArm();
  await showFilm(job);
}

function showAsked(job) {
  showOptions(job.options);
  if (linesOf) layers.show(linesOf, job.options.layers ?? "");
  sheet.show({ options: placement(), ...(linesOf && { lines: layers.of(linesOf) }) });
  sayPlace();
}

/** What would be typed for the options as they stand, once they stand still. */
function sayCommand() {
  clearTimeout(commandSoon);
  commandSoon = setTimeout(async () => {
    const id = current;
    if (!id || jobs.get(id)?.state === "reading") return showCommand("");
    const { command } = await post(`/api/jobs/${id}/command`, asked()).catch(() => ({}));
    if (command && id === current && jobs.get(id)?.state !== "planning") showCommand(command);
  }, 250);
}

function showCommand(command) {
  $("command-box").hidden = !command;
  $("command").textContent = command;
}

function sayPlace() {
  const says = $("sheet-says");
  const found = sheet.placement;
  const name = $("arm").value;
  says.className = "";
  if (sheet.arm?.chosen !== name) return void (says.textContent = `Working out what ${name} reaches …`);
  if (!found) return void (says.textContent = sheet.arm?.refusal ?? (current ? "" : "Drop a drawing on this page to begin."));
  const [width, height] = found.size.map((side) => (side * found.factor).toFixed(1));
  const over = found.over > 0.01 ? ` It goes ${found.over.toFixed(1)} mm over the edge of what can be drawn on.` : "";
  says.className = over ? "bad" : "";
  says.textContent = `${width} × ${height} mm, ${(100 * found.factor).toFixed(1)} % of its size.${over}`;
}

function sayMap() {
  const { map, arm } = sheet;
  const range = map?.range;
  $("map-of").textContent = arm?.map?.is_expected ? "the error that is expected over the paper" : "how far the pen strays for each degree that a joint is off";
  $("map-legend").hidden = !sheet.showsMap || !range;
  if (range) [$("map-least").textContent, $("map-most").textContent] = range.map((mm) => `${mm.toFixed(2)} mm`);
}

// -- drawings -------------------------------------------------------------------------------------------------------

async function choose(id) {
  const isOther = id !== current;
  current = id;
  const job = jobs.get(id);
  drawJobs();
  if (!job) return showNothing();
  if (isOther) {
    forgetFilm();
    showOptions(job.options);
  }
  showJob(job);
  if (run) showRun();
  await Promise.all([showArm(), showLines(job)]);
  sheet.show({ options: placement() });
  await showFilm(job);
  sayPlace();
}

async function showNothing() {
  linesOf = null;
  layers.show(null, "");
  sheet.show({ lines: null, options: placement() });
  forgetFilm();
  for (const id of ["command-box", "plan-box", "run-box", "progress", "cancel", "plan-stale"]) $(id).hidden = true;
  $("plan-says").textContent = "";
  await showArm();
  sayPlace();
}

async function showLines(job) {
  if (!lines.has(job.id) && job.state !== "reading" && !(job.state === "failed" && !job.command)) {
    const found = await get(`/api/jobs/${job.id}/lines`).catch(() => null);
    if (found) lines.set(job.id, found);
  }
  if (job.id !== current || linesOf === lines.get(job.id)) return;
  linesOf = lines.get(job.id);
  layers.show(linesOf, job.options.layers ?? "");
  sheet.show({ lines: layers.of(linesOf) });
}

async function showArm() {
  const name = $("arm").value;
  sayPlace();
  if (!arms.has(name)) {
    const found = get(`/api/arms/${name}`).catch((error) => ({ name, refusal: error.message }));
    arms.set(name, found.then((arm) => ({ ...arm, chosen: name })));
  }
  const arm = await arms.get(name);
  if (name === $("arm").value && sheet.arm !== arm) {
    sheet.show({ arm });
    sayPlace();
    sayMap();
  }
  return arm;
}

function forgetFilm() {
  film = filmOf = null;
  plays = false;
  sheet.show({ film: null });
  showPens($("pens"), []);
  armView.show(null);
  jointsView.show(null);
  showFilmParts();
}

async function showFilm(job) {
  if (job.state !== "planned" || filmOf === job.id) return;
  const found = await get(`/api/jobs/${job.id}/motion`).catch(() => null);
  if (!found || job.id !== current) return;
  const arm = await showArm();
  film = unpacked(found);
  filmOf = job.id;
  sheet.show({ film });
  showPens($("pens"), film.pens);
  armView.show(film, arm);
  jointsView.show(film);
  showFilmParts();
  Object.assign($("time"), { min: film.begin, max: film.end });
  seek(film.end);
}

/** What there is to see of a film. */
function showFilmParts() {
  const isArm = $("tab-arm").getAttribute("aria-selected") === "true";
  $("film").hidden = !film;
  $("view-joints").hidden = !film || !isArm;
  $("arm-waits").hidden = film !== null;
}

/** What has changed is planned again before it is drawn. */
function showWhatCanRun() {
  const isPlanned = jobs.get(current)?.state === "planned";
  $("plan-stale").hidden = !isStale || !isPlanned;
  $("plan-box").hidden = isStale || !isPlanned;
  const isBusy = run !== null && (run.stand !== "idle" || jogPage.runs);
  for (const id of ["run", "resume", "frame"]) $(id).disabled = isBusy || isStale;
  sheet.isLocked = isBusy && run.job === current;
}

function showJob(job) {
  const isBusy = job.state === "planning" || job.state === "reading";
  $("progress").hidden = !isBusy;
  $("progress").value = job.progress;
  $("cancel").hidden = job.state !== "planning";
  $("plan").disabled = isBusy;
  const says = $("plan-says");
  says.className = job.state === "failed" ? "bad" : job.state === "planned" ? "good" : "";
  says.textContent =
    job.state === "failed" || job.error ? job.error
    : job.state === "planning" ? `${job.stage || "waiting"}, ${Math.round(100 * job.progress)} %`
    : job.state === "reading" ? "reading"
    : job.state === "planned" ? job.summary[0] ?? "planned" : "";
  $("plan-notes").replaceChildren(...[...(job.state === "planned" ? job.summary.slice(1) : []), ...job.notes].map(item));
  const isPlanned = job.state === "planned";
  $("picture-box").hidden = job.name.endsWith(".svg") || job.name.endsWith(".svgz");
  if (job.command && !isStale) showCommand(job.command);
  else sayCommand();
  Object.assign($("download"), { href: `/api/jobs/${job.id}/trajectory`, download: job.trajectory });
  $("run-box").hidden = !isPlanned;
  $("resume").hidden = !job.resumable;
  $("run").textContent = job.drawn.length ? "Draw again" : "Draw";
  $("runs-box").hidden = !job.drawn.length;
  $("runs").replaceChildren(...job.drawn.toReversed().map(({ at, driver, how }) => item(`${when(at)}, ${driver}: ${how}`)));
  showWhatCanRun();
}

const when = (seconds) => new Date(1000 * seconds).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });

const STANDS = {
  idle: "", starting: "connecting", playing: "drawing", paused: "paused, pen up", "awaiting pen": "waiting for a pen",
  stopping: "stopping",
};
const SAYS = { reading: "reading", read: "not planned yet", planning: "planning", planned: "planned", failed: "cannot be drawn" };

function drawJobs() {
  const list = [...jobs.values()].sort((a, b) => b.made - a.made).map((job) => {
    const li = document.createElement("li");
    const choice = Object.assign(document.createElement("button"), { type: "button", className: "job" });
    const [name, state] = [document.createElement("span"), document.createElement("small")];
    name.textContent = job.name;
    const drawn = job.drawn.length ? `, ${job.drawn.at(-1).how}` : "";
    state.textContent = (run?.job === job.id && run.stand !== "idle" ? STANDS[run.stand] : SAYS[job.state]) + drawn;
    choice.append(name, state);
    choice.setAttribute("aria-current", String(job.id === current));
    choice.addEventListener("click", () => choose(job.id));
    const away = Object.assign(document.createElement("button"), { type: "button", textContent: "×", title: "Throw away" });
    away.setAttribute("aria-label", `Throw away ${job.name}`);
    away.addEventListener("click", () => tried($("plan-says"), () => remove(`/api/jobs/${job.id}`)));
    li.append(choice, away);
    return li;
  });
  $("jobs").replaceChildren(...list);
}

async function add(files) {
  await started;
  for (const file of files) {
    await tried($("plan-says"), async () => {
      const job = await upload(file);
      if (!jobs.has(job.id)) jobs.set(job.id, job); // else it has been told of later
      await choose(job.id);
    });
  }
}

async function jobChanged(job) {
  const before = jobs.get(job.id);
  if (job.gone) jobs.delete(job.id);
  else jobs.set(job.id, job);
  if (job.gone && current === job.id) return choose([...jobs.keys()].at(-1) ?? null);
  drawJobs();
  if (job.id !== current) return;
  if (job.state === "planning" && before?.state !== "planning") showAsked(job); // another page may have asked
  showJob(job);
  if (before?.state !== job.state) {
    if (job.state !== "planned") forgetFilm();
    await showLines(job);
    sayPlace();
    await showFilm(job);
  }
}

// -- the film -------------------------------------------------------------------------------------------------------

function seek(to) {
  if (!film) return;
  time = Math.min(Math.max(to, film.begin), film.end);
  const sample = time * film.rate;
  $("time").value = time;
  $("time-says").textContent = `${time.toFixed(1)} of ${film.end.toFixed(1)} s`;
  sheet.until = sample;
  sheet.draw();
  armView.at(time, sample);
  jointsView.at(time);
}

function play(on) {
  plays = on && film !== null;
  $("play").textContent = plays ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", plays ? "Pause the film" : "Play");
  if (!plays) return;
  if (time >= film.end) time = film.begin;
  last = performance.now();
  requestAnimationFrame(step);
}

function step(now) {
  if (!plays || !film) return;
  seek(time + ((now - last) / 1000) * Number($("pace").value));
  last = now;
  if (time >= film.end) play(false);
  else requestAnimationFrame(step);
}

// -- the run --------------------------------------------------------------------------------------------------------

function runChanged(now) {
  const before = run;
  run = now;
  const runs = run.stand !== "idle";
  const { name } = run;
  const left = run.left_s > 60 ? `${Math.round(run.left_s / 60)} min` : `${Math.round(run.left_s)} s`;
  const share = run.total ? `, ${Math.floor((100 * run.reached) / run.total)} %, ${left} left` : "";
  const jogs = jogPage.runs;
  const standing = jogs ? `jogging ${jogPage.jog.arm}`
    : runs ? `${name}: ${STANDS[run.stand]}${share}`
    : run.ended ? `${name}: ${run.ended}` : "";
  say($("standing"), standing);
  $("pause").hidden = !["playing", "paused"].includes(run.stand);
  $("pause").textContent = run.stand === "paused" ? "Go on" : "Pause";
  $("pen").hidden = run.stand !== "awaiting pen";
  $("pen").textContent = `${run.pen} is in: go on`;
  $("stop").hidden = !runs;
  $("hold").hidden = !runs && !jogs;
  showRun();
  if (before?.stand !== run.stand) drawJobs();
}

/** Of the drawing that is shown. */
function showRun() {
  const isOwn = run.job === current;
  const runs = isOwn && run.stand !== "idle";
  showWhatCanRun();
  say($("run-says"), runs ? STANDS[run.stand] : isOwn ? run.ended : "", isOwn && !runs && run.ended ? (run.complete ? "good" : "bad") : "");
  $("run-notes").replaceChildren(...(runs ? run.link : isOwn ? run.lines : []).map(item));
  if (runs && film && filmOf === run.job && run.total) {
    play(false);
    seek(run.sample / film.rate);
  }
}

function jogChanged(jog) {
  jogPage.show(jog);
  if (run) runChanged(run);
}

function begin(more) {
  return tried($("run-says"), async () => {
    const driver = $("driver").value;
    const options = { driver, "speed-factor": Number($("speed-factor").value), ...more };
    if ($("port").value && !simulators.includes(driver)) options.port = $("port").value;
    await post(`/api/jobs/${current}/run`, options);
  });
}

const wish = (name) => tried($("run-says"), () => post(`/api/run/${name}`));

// -- everything together --------------------------------------------------------------------------------------------

let [drivers, simulators] = [[], []];
let connected;
let started = new Promise((done) => (connected = done)); // what the server knows is here

/** One may have been saved anew under its name. */
function armsChanged(names) {
  arms.clear();
  offer($("arm"), names);
  jogPage.offer(names, drivers, simulators);
  calibrationPage.offer(names, drivers, simulators);
  return showArm();
}

function page() {
  const name = ["draw", "jog", "calibrate"].find((each) => location.hash === `#${each}`) ?? "draw";
  for (const each of ["draw", "jog", "calibrate"]) $(`page-${each}`).hidden = each !== name;
  for (const link of document.querySelectorAll(".pages a")) {
    if (link.hash === `#${name}`) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  document.querySelector(".skip").hidden = name !== "draw";
  $("arm-choice").hidden = name !== "draw";
  sheet.draw();
  armView.draw();
  jointsView.draw();
}

async function start() {
  const state = await get("/api/state");
  simulators = state.simulators;
  drivers = state.drivers;
  offer($("driver"), drivers);
  showPort();
  armsChanged(state.arms);
  calibrationPage.show(state.calibration);
  jobs.clear();
  for (const job of state.jobs) jobs.set(job.id, job);
  run = state.run;
  jogChanged(state.jog);
  await choose(jobs.has(current) ? current : jobs.has(run.job) && run.stand !== "idle" ? run.job : [...jobs.keys()].at(-1) ?? null);
  runChanged(run); // by now the film is there
}

/** Simulated arms have none. */
const showPort = () => ($("port-box").hidden = simulators.includes($("driver").value));

function tab(name) {
  for (const each of ["sheet", "arm"]) {
    $(`view-${each}`).hidden = each !== name;
    $(`tab-${each}`).setAttribute("aria-selected", String(each === name));
    $(`tab-${each}`).tabIndex = each === name ? 0 : -1;
  }
  showFilmParts();
  sheet.draw();
  armView.draw();
  jointsView.draw();
}

for (const name of ["sheet", "arm"]) $(`tab-${name}`).addEventListener("click", () => tab(name));
document.querySelector("[role=tablist]").addEventListener("keydown", (event) => {
  const tabs = [...event.currentTarget.children];
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!step) return;
  const next = tabs[(tabs.indexOf(document.activeElement) + step + tabs.length) % tabs.length];
  next.click();
  next.focus();
});
$("file").addEventListener("change", (event) => {
  add([...event.target.files]);
  event.target.value = "";
});
document.addEventListener("dragover", (event) => {
  event.preventDefault();
  document.body.classList.add("over");
});
document.addEventListener("dragleave", () => document.body.classList.remove("over"));
document.addEventListener("drop", (event) => {
  event.preventDefault();
  document.body.classList.remove("over");
  add([...event.dataTransfer.files]);
});
$("arm").addEventListener("change", () => {
  placeChanged();
  showArm();
});
form.addEventListener("input", (event) => {
  if (!event.target.closest("#run-box")) placeChanged();
});
form.addEventListener("submit", (event) => {
  event.preventDefault();
  if (!current) return void ($("plan-says").textContent = "Drop a drawing first.");
  tried($("plan-says"), async () => {
    await post(`/api/jobs/${current}/plan`, asked());
    isStale = false;
    showWhatCanRun();
  });
});
$("fit").addEventListener("click", () => {
  for (const name of ["at-x", "at-y", "scale"]) field(name).value = "";
  placeChanged();
});
$("cancel").addEventListener("click", () => tried($("plan-says"), () => post(`/api/jobs/${current}/cancel`)));
$("unchange").addEventListener("click", unchange);
$("driver").addEventListener("change", showPort);
$("quantity").addEventListener("change", (event) => jointsView.showQuantity(event.target.value));
for (const text of document.querySelectorAll("pre")) copyable(text);
$("show-map").addEventListener("change", (event) => {
  sheet.showsMap = event.target.checked;
  sayMap();
  sheet.draw();
});
$("play").addEventListener("click", () => play(!plays));
$("time").addEventListener("input", (event) => {
  plays = false;
  seek(Number(event.target.value));
});
$("run").addEventListener("click", () => begin({}));
$("resume").addEventListener("click", () => begin({ resume: true, driver: jobs.get(current).resumable }));
$("frame").addEventListener("click", () => begin({ frame: true }));
for (const id of ["port", "jog-port", "walk-port"]) {
  $(id).addEventListener("focus", async () => {
    const found = await get("/api/ports").catch(() => []);
    $("ports").replaceChildren(...found.map(({ port, likely }) => element("option", "", { value: port, label: likely })));
  });
}
$("pause").addEventListener("click", () => wish(run.stand === "paused" ? "resume" : "pause"));
$("pen").addEventListener("click", () => wish("pen"));
$("stop").addEventListener("click", () => wish("stop"));
$("hold").addEventListener("click", () => (jogPage.runs ? tried($("jog-says"), () => post("/api/jog/stop")) : wish("hold")));

addEventListener("hashchange", page);
page();

const parts = {
  job: jobChanged,
  run: runChanged,
  jog: jogChanged,
  calibration: (walk) => calibrationPage.show(walk),
  arms: armsChanged,
};
watch(parts, {
  onConnected: () => {
    $("lost").hidden = true;
    started = start().catch((error) => say($("plan-says"), error.message, "bad"));
    connected(started);
  },
  onLost: () => ($("lost").hidden = false),
});
