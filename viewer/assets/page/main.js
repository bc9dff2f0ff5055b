// The page: what comes from the program or from a recording is drawn, what the pilot asks for goes back.

import { Controls } from "./controls.js";
import { History } from "./history.js";
import { Horizon } from "./horizon.js";
import { Panel } from "./panel.js";
import { Plots } from "./plots.js";
import { Recording, readRecording } from "./replay.js";
import { View } from "./scene.js";
import { Stream } from "./stream.js";

const KEPT = 1800;
const KEPT_S = 60;
const find = (id) => document.getElementById(id);

const page = {
  frame: null, news: { vehicles: [], texts: [] }, scene: { vehicles: [], obstacles: [] }, chosen: null, histories: new Map(),
  recording: null, stream: null, connection: null, isPilot: false, dirty: false,
};

const controls = new Controls((action, parameters) => page.stream.ask(page.chosen, action, parameters), {
  recording: () => page.recording,
  follow: () => follow(!view.follows),
  choose: (number) => choose(page.frame?.vehicles[number - 1]?.id ?? page.chosen),
});
const view = new View(find("view"), find("labels"), (place) => { if (!page.recording) controls.flyTo(place); }, () => controls.height());
const horizon = new Horizon(find("horizon"));
const plots = new Plots(find("charts"));
const panel = new Panel(find("state"), find("vehicles"), find("texts"), choose);

function choose(id) {
  page.chosen = id;
  page.dirty = true;
  if (page.frame) panel.offer(page.frame.vehicles.map((vehicle) => vehicle.id), id);
}

function follow(on) {
  view.follows = on;
  find("follow").setAttribute("aria-pressed", String(on));
}

/** Takes in how things are. */
function take(frame) {
  page.frame = frame;
  page.dirty = true;
  if (!frame.vehicles.some(({ id }) => id === page.chosen)) choose(frame.vehicles[0]?.id ?? null);
  panel.offer(frame.vehicles.map(({ id }) => id), page.chosen);
  for (const state of frame.vehicles) historyOf(state.id).push(frame.time, state);
}

function historyOf(id) {
  if (!page.histories.has(id)) page.histories.set(id, new History(KEPT));
  return page.histories.get(id);
}

function play(now) {
  const { recording } = page;
  recording.advance(now);
  if (recording.sought) {
    recording.sought = false;
    for (const id of recording.states.keys()) {
      historyOf(id).clear();
      for (const [time, state] of recording.past(id, KEPT_S)) historyOf(id).push(time, state);
    }
  }
  take(recording.frame());
  const seek = find("seek");
  if (document.activeElement !== seek || !recording.paused) seek.value = recording.time;
  seek.setAttribute("aria-valuetext", `${recording.time.toFixed(1)} s of ${recording.end.toFixed(1)} s`);
}

function draw(now) {
  requestAnimationFrame(draw);
  if (page.recording) play(now);
  const { frame, chosen } = page;
  if (!frame || frame.vehicles.length === 0) return;
  find("time").textContent = `${frame.time.toFixed(1)} s`;
  find("pace").textContent = pace(frame);
  controls.showSpeed(frame.speed);
  view.draw(frame.vehicles, (id) => historyOf(id).places, chosen);
  if (!page.dirty) return;
  page.dirty = false;
  const state = frame.vehicles.find(({ id }) => id === chosen);
  if (!state) return;
  horizon.draw(state.quaternion, now);
  panel.draw(state, page.recording ? null : page.news.vehicles.find(({ id }) => id === chosen), now);
  plots.draw(historyOf(chosen), now);
}

function pace({ speed, pace: measured }) {
  if (speed === 0) return "paused";
  if (!Number.isFinite(measured)) return `${speed} × real time`;
  return `${measured.toPrecision(2)} × real time`;
}

function connect() {
  page.stream = new Stream({
    frame: (frame) => { if (!page.recording) take(frame); },
    scene: (scene) => {
      page.scene = scene;
      if (!page.recording) view.describe(scene);
    },
    news: (news) => {
      page.news = news;
      if (!page.recording) panel.say(news.texts);
    },
    controls: (isPilot) => {
      page.isPilot = isPilot;
      allow();
    },
    state: (state) => {
      page.connection = state;
      if (!page.recording) tellConnection();
    },
  });
}

function tellConnection() {
  const texts = { connecting: "connecting", live: "live", lost: "connection lost, trying again" };
  find("connection").dataset.state = page.connection;
  find("connection").textContent = texts[page.connection];
}

function allow() {
  controls.allow(page.isPilot && !page.recording, !page.recording);
  find("hint").textContent = page.isPilot && !page.recording ? "Click a place to fly there" : "";
}

/** Shows a recording, or the flight again. */
function show(recording) {
  page.recording = recording;
  page.histories.clear();
  page.frame = null;
  view.describe(recording ? { vehicles: [], obstacles: [] } : page.scene);
  find("player").hidden = !recording;
  find("messages").hidden = Boolean(recording);
  find("close").hidden = !recording || !page.stream;
  if (recording) {
    find("recording-name").textContent = recording.name;
    Object.assign(find("seek"), { min: recording.start, max: recording.end, value: recording.start });
    find("connection").textContent = "recording";
    find("connection").dataset.state = "recording";
  }
  allow();
}

function open(name, buffer) {
  try {
    show(new Recording(name, readRecording(name, buffer)));
  } catch (error) {
    find("answer").textContent = `${name}: ${error.message}`;
    find("connection").textContent = `${name}: ${error.message}`;
    find("connection").dataset.state = "lost";
  }
}

find("file").addEventListener("change", async ({ target }) => {
  const [file] = target.files;
  target.value = "";
  if (file) open(file.name, await file.arrayBuffer());
});
find("close").addEventListener("click", () => {
  show(null);
  tellConnection();
});
find("seek").addEventListener("input", ({ target }) => page.recording?.seek(Number(target.value)));
find("follow").addEventListener("click", () => follow(!view.follows));
find("from-above").addEventListener("click", () => view.fromAbove());
find("everything").addEventListener("click", () => {
  follow(false);
  view.showAll(page.frame?.vehicles ?? []);
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  view.recolour();
  horizon.recolour();
  plots.build();
});

const { recording } = await (await fetch("/session.json")).json();
if (recording) {
  open(recording, await (await fetch("/recording")).arrayBuffer());
} else {
  allow();
  connect();
}
// Programs look here: what is shown, and where on the screen.
window.lmpcView = { page, view };
requestAnimationFrame(draw);
