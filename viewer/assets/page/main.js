// The page: what comes from the program or from a recording is drawn, what the pilot asks for goes back.

import { Controls } from "./controls.js";
import { replayed } from "./film.js";
import { graphics } from "./graphics.js";
import { History } from "./history.js";
import { Horizon } from "./horizon.js";
import { Panel } from "./panel.js";
import { Plots } from "./plots.js";
import { Rarely } from "./rarely.js";
import { Redraw } from "./redraw.js";
import { Recording, isRecord, readRecording } from "./replay.js";
import { View } from "./scene.js";
import { Stream, token } from "./stream.js";

const KEPT = 1800;
const KEPT_S = 60;
/** Numbers are not read more often, ms. */
const READ_MS = 200;
const find = (id) => document.getElementById(id);

const page = {
  frame: null, news: { vehicles: [], texts: [] }, scene: { vehicles: [], obstacles: [] }, chosen: null, histories: new Map(),
  recording: null, stream: null, connection: null, isPilot: null,
};

const redraw = new Redraw(draw);
const controls = new Controls((action, parameters) => page.stream.ask(page.chosen, action, parameters), {
  recording: () => page.recording,
  moved: () => redraw.ask(),
  follow: () => follow(!view?.follows),
  choose: (number) => choose(page.frame?.vehicles[number - 1]?.id ?? page.chosen),
});
const { works, isSoftware } = graphics();
find("no-graphics").hidden = works;
/** Null where the browser cannot draw in three dimensions; everything else works without. */
const view = works ? new View(find("view"), find("labels"), isSoftware, {
  place: (place) => { if (!page.recording) controls.flyTo(place); },
  height: () => controls.height(),
  change: () => redraw.ask(),
}) : null;
const horizon = new Horizon(find("horizon"));
const plots = new Plots(find("plots"));
const panel = new Panel(find("state"), find("vehicles"), find("texts"), choose);
const numbers = new Rarely(READ_MS, () => {
  const state = chosenState();
  if (state) panel.draw(state, newsOf(state.id, page.frame.time));
});

function choose(id) {
  page.chosen = id;
  if (page.frame) panel.offer(page.frame.vehicles.map((vehicle) => vehicle.id), id);
  redraw.ask();
}

function follow(on) {
  if (view) view.follows = on;
  find("follow").setAttribute("aria-pressed", String(on));
  redraw.ask();
}

/** Takes in how things are. */
function take(frame) {
  page.frame = frame;
  if (!frame.vehicles.some(({ id }) => id === page.chosen)) choose(frame.vehicles[0]?.id ?? null);
  panel.offer(frame.vehicles.map(({ id }) => id), page.chosen);
  for (const state of frame.vehicles) historyOf(state.id).push(frame.time, state);
  redraw.ask();
}

function historyOf(id) {
  if (!page.histories.has(id)) page.histories.set(id, new History(KEPT));
  return page.histories.get(id);
}

/** Goes on with a recording. */
function play(now) {
  const { recording } = page;
  if (!recording.advance(now) && page.frame) return;
  if (recording.sought) {
    recording.sought = false;
    panel.forget();
    for (const id of recording.states.keys()) {
      historyOf(id).clear();
      for (const [time, state] of recording.past(id, KEPT_S)) historyOf(id).push(time, state);
    }
  }
  take(recording.frame());
  panel.say(recording.textsNow(), recording.states.size > 1);
  const seek = find("seek");
  if (document.activeElement !== seek || !recording.paused) seek.value = recording.time;
  seek.setAttribute("aria-valuetext", `${recording.time.toFixed(1)} s of ${recording.end.toFixed(1)} s`);
}

/** Draws how things are. Returns whether they change by themselves. */
function draw(now, waited) {
  if (page.recording) play(now);
  const goesOn = Boolean(page.recording && !page.recording.paused);
  const { frame, chosen } = page;
  if (!frame || frame.vehicles.length === 0) return goesOn;
  write("time", `${frame.time.toFixed(1)} s,`);
  write("pace", pace(frame));
  controls.showSpeed(frame.speed);
  view?.draw(frame.vehicles, (id) => historyOf(id).places, chosen);
  view?.pace(waited, now);
  if (view) write("scale", `Squares of ${view.step} m`);
  const state = chosenState();
  if (!state) return goesOn;
  horizon.draw(state.quaternion);
  numbers.ask();
  plots.draw(historyOf(chosen));
  return goesOn;
}

function chosenState() {
  return page.frame?.vehicles.find(({ id }) => id === page.chosen);
}

/** Writes a text, if it is another: the browser lays out again what is written. */
function write(id, text) {
  const part = find(id);
  if (part.textContent !== text) part.textContent = text;
}

/** What is said of a vehicle at a time, s. */
function newsOf(id, time) {
  const vehicles = page.recording ? page.recording.newsAt(time) : page.news.vehicles;
  return vehicles.find((vehicle) => vehicle.id === id);
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
      if (!page.recording) view?.describe(scene);
    },
    news: (news) => {
      page.news = news;
      if (!page.recording) panel.say(news.texts, news.vehicles.length > 1);
      redraw.ask();
    },
    controls: (isPilot) => {
      page.isPilot = isPilot;
      allow();
    },
    state: (state, reason) => {
      page.connection = { state, reason };
      // What the program has answered is not what the one after it does.
      if (state === "lost") controls.tell("", false);
      if (!page.recording) tellConnection();
    },
  });
}

function tellConnection() {
  const { state, reason } = page.connection;
  const texts = { connecting: "connecting", live: "live", lost: reason ?? "connection lost, trying again" };
  find("connection").dataset.state = state;
  write("connection", texts[state]);
}

function allow() {
  write("why-view-only", token()
    ? "The token is from another run: to give commands, open the address that lmpc-sitl printed last."
    : "To give commands, open the address with the token that lmpc-sitl printed.");
  controls.allow(page.isPilot === true && !page.recording, !page.recording);
  // Null: the program has not said it yet.
  find("view-only").hidden = page.isPilot !== false || Boolean(page.recording);
  write("hint", page.isPilot && !page.recording && works ? "Click a place to fly there" : "");
}

/** Shows a recording, or the flight again. */
function show(recording) {
  page.recording = recording;
  page.histories.clear();
  page.frame = null;
  view?.describe(recording ? recording.scene : page.scene);
  find("player").hidden = !recording;
  find("messages").hidden = recording?.texts.length === 0;
  panel.forget();
  find("close").hidden = !recording || !page.stream;
  if (!recording) panel.say(page.news.texts, page.news.vehicles.length > 1);
  if (recording) {
    write("recording-name", recording.name);
    Object.assign(find("seek"), { min: recording.start, max: recording.end, value: recording.start });
    write("connection", "recording");
    find("connection").dataset.state = "recording";
  }
  allow();
  redraw.ask();
}

async function open(name, buffer) {
  try {
    let content = buffer;
    if (isRecord(name, buffer) && isServed()) {
      write("connection", `replaying ${name}`);
      content = await replayed(buffer, token());
    }
    show(new Recording(name, readRecording(name, content)));
  } catch (error) {
    const text = `${name}: ${error.message}`;
    controls.tell(text, true);
    // Answers to orders are not shown beside a recording.
    if (page.stream && !page.recording) return tellConnection();
    write("connection", text);
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
find("seek").addEventListener("input", ({ target }) => {
  page.recording?.seek(Number(target.value));
  redraw.ask();
});
find("follow").addEventListener("click", () => follow(!view?.follows));
find("from-above").addEventListener("click", () => view?.fromAbove());
find("everything").addEventListener("click", () => {
  follow(false);
  view?.showAll(page.frame?.vehicles ?? []);
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  view?.recolour();
  horizon.recolour();
  plots.build();
  redraw.ask();
});

/** Whether a program serves the page: what is on a disk has none. */
function isServed() {
  return location.protocol.startsWith("http");
}

/** The recording that is within the page, if it is a file of its own. */
function enclosed() {
  const element = find("recording");
  if (!element) return null;
  const bytes = Uint8Array.from(atob(element.textContent), (letter) => letter.charCodeAt(0));
  return [element.dataset.name, bytes.buffer];
}

/** What the page is for: a recording within it or at its server, else the flight. */
async function begin() {
  const own = enclosed();
  if (own) return open(...own);
  const { recording } = await (await fetch("/session.json")).json();
  if (recording) return open(recording, await (await fetch("/recording")).arrayBuffer());
  allow();
  connect();
}

await begin();
// Programs look here: what is shown, and where on the screen.
window.lmpcView = { page, view };
redraw.ask();
