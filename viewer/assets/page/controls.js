// Commands by button, form and key.

const KEYS = { t: "take_off", h: "hold", l: "land", r: "return", m: "start_mission" };
const STEP_S = 0.1;

export class Controls {
  /** `ask(action, parameters)` resolves with why it is refused, or null. */
  constructor(ask, on) {
    this.ask = ask;
    this.on = on;
    this.allowed = false;
    this.answer = document.getElementById("answer");
    this.pause = document.getElementById("pause");
    this.speed = document.getElementById("speed");
    this.form = (id) => document.getElementById(id).elements;
    for (const button of document.querySelectorAll("[data-action]")) {
      button.addEventListener("click", () => this.order(button.dataset.action, this.parameters(button.dataset.action)));
    }
    this.submit("fly-to", ({ north, east }) => this.flyTo([Number(north.value), Number(east.value)]));
    this.submit("wind", ({ speed, from }) => this.order("wind", { speed_m_s: Number(speed.value), from_deg: Number(from.value) }));
    this.submit("fault", ({ unit, kind }) => this.order("fault", { fault: `${unit.value}=${kind.value}` }));
    this.pause.addEventListener("click", () => this.togglePause());
    document.getElementById("step").addEventListener("click", () => this.step());
    this.speed.addEventListener("change", () => this.setSpeed(Number(this.speed.value)));
    document.addEventListener("keydown", (event) => this.key(event));
  }

  submit(id, act) {
    const form = document.getElementById(id);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      act(form.elements);
    });
  }

  /** How high the next place is, m. */
  height() {
    return Number(this.form("fly-to").height.value);
  }

  parameters(action) {
    return action === "take_off" ? { height_m: this.height() } : {};
  }

  /** Flies to a place, north and east, m, above the ground there. */
  flyTo([north, east]) {
    const { elements } = document.getElementById("fly-to");
    elements.north.value = north.toFixed(2);
    elements.east.value = east.toFixed(2);
    return this.order("fly_to", { place_m: [north, east], height_m: this.height() });
  }

  async order(action, parameters = {}) {
    if (!this.allowed) return this.say(action, "view only");
    return this.say(action, await this.ask(action, parameters));
  }

  say(action, refused) {
    this.tell(`${action.replaceAll("_", " ")}: ${refused || "accepted"}`, Boolean(refused));
  }

  /** Shows what has become of an order. */
  tell(text, bad) {
    this.answer.textContent = text;
    this.answer.classList.toggle("bad", bad);
  }

  /** Whether orders are taken; recordings are steered without. */
  allow(allowed, live) {
    this.allowed = allowed;
    for (const part of document.querySelectorAll("#commands :is(button, input, select)")) part.disabled = !allowed;
    document.getElementById("commands").hidden = !live;
    for (const part of document.querySelectorAll("#time-controls :is(button, select)")) part.disabled = live && !allowed;
  }

  /** Shows the speed that holds, whoever has set it. */
  showSpeed(speed) {
    const paused = speed === 0;
    if (this.pause.getAttribute("aria-pressed") !== String(paused)) this.pause.setAttribute("aria-pressed", String(paused));
    this.paused = paused;
    if (paused || document.activeElement === this.speed) return;
    const value = Number.isFinite(speed) ? String(Number(speed.toPrecision(4))) : "-1";
    if (![...this.speed.options].some((option) => option.value === value)) this.speed.add(new Option(value, value));
    this.speed.value = value;
  }

  /** Does something to the time of a recording. */
  steer(act) {
    act(this.on.recording());
    this.on.moved();
  }

  togglePause() {
    if (this.on.recording()) return this.steer((recording) => recording.togglePause());
    return this.order("speed", { factor: this.paused ? Number(this.speed.value) : 0 });
  }

  step() {
    if (this.on.recording()) return this.steer((recording) => recording.step(STEP_S));
    return this.order("step", { time_s: STEP_S });
  }

  setSpeed(factor) {
    if (this.on.recording()) return this.steer((recording) => recording.setSpeed(factor));
    return this.order("speed", { factor });
  }

  key(event) {
    const inField = event.target.closest?.("input, select, textarea");
    if (inField || event.ctrlKey || event.altKey || event.metaKey) return;
    const onButton = event.target.closest?.("button, a");
    if (event.key === " " && !onButton) this.togglePause();
    else if (event.key === ".") this.step();
    else if (event.key === "f") this.on.follow();
    else if (/^[1-9]$/.test(event.key)) this.on.choose(Number(event.key));
    else if (event.key in KEYS && !this.on.recording()) this.order(KEYS[event.key], this.parameters(KEYS[event.key]));
    else return;
    event.preventDefault();
  }
}
