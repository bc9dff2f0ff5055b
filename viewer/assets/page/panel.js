// The chosen vehicle in words and numbers, and the choice among several.

const SOLVER = ["optimal", "relaxed", "iteration limit", "held"];
const LAW = ["altitude", "position", "attitude"];

function metres(values) {
  const [north, east, down] = values.map((value) => (Math.round(value * 100) / 100 + 0).toFixed(2));
  return `N ${north}, E ${east}, up ${(-down + 0).toFixed(2)} m`;
}

/** Rows of the table: name, text, and whether it is bad. */
function rows(state, news) {
  const speed = Math.hypot(...state.velocity);
  const error = Math.hypot(...state.position.map((value, index) => value - state.setpoint[index]));
  const known = (value, text) => (Number.isFinite(value) ? text : "unknown");
  const situation = [
    state.lost && "simulation failed", state.crashed && "crashed", state.failsafe && "failsafe",
    state.armed ? "armed" : "disarmed", state.landed ? "on the ground" : "in the air",
  ].filter(Boolean);
  const limits = LAW.filter((_, index) => state.active[index] > 0).map((law) => `${law} ${state.active[LAW.indexOf(law)]}`);
  const worst = Math.max(...state.status);
  return [
    ["Mode", news?.mode ?? "unknown", false],
    ["State", situation.join(", "), state.lost || state.crashed || state.failsafe],
    ["Position", metres(state.position), false],
    ["Speed", known(speed, `${speed.toFixed(2)} m/s`), false],
    ["Tracking error", state.tracks ? known(error, `${error.toFixed(3)} m`) : "no set-point", false],
    ["Thrust", known(state.thrust, `${state.thrust.toFixed(2)} N${Number.isFinite(state.strongest) ? ` of ${state.strongest.toFixed(1)}` : ""}`), false],
    ["Active limits", limits.join(", ") || "none", false],
    ["Solver", `${SOLVER[worst]}, ${state.iterations.reduce((sum, count) => sum + count, 0)} iterations`, worst > 1],
    ["Battery", known(state.battery, `${(100 * state.battery).toFixed(0)} %, ${state.voltage.toFixed(1)} V`), state.battery < 0.2],
    ["Wind", known(state.wind[0], `${Math.hypot(...state.wind).toFixed(1)} m/s`), false],
    ["Faults", news?.faults.join(", ") || "none", Boolean(news?.faults.length)],
  ];
}

export class Panel {
  constructor(list, choice, texts, onChoose) {
    Object.assign(this, { list, choice, texts, onChoose });
    this.lastText = 0;
  }

  /** Shows a state. */
  draw(state, news) {
    const all = rows(state, news);
    if (this.list.children.length !== 2 * all.length) {
      this.list.replaceChildren(...all.flatMap(([name]) => {
        const term = document.createElement("dt");
        term.textContent = name;
        return [term, document.createElement("dd")];
      }));
    }
    all.forEach(([, text, bad], index) => {
      const cell = this.list.children[2 * index + 1];
      if (cell.textContent !== text) cell.textContent = text;
      cell.classList.toggle("bad", Boolean(bad));
    });
  }

  /** Offers the vehicles that there are. */
  offer(ids, chosen) {
    const text = ids.join();
    if (text !== this.offered) {
      this.offered = text;
      this.choice.replaceChildren(...ids.map((id) => this.option(id)));
    }
    this.choice.hidden = ids.length < 2;
    for (const input of this.choice.querySelectorAll("input")) input.checked = Number(input.value) === chosen;
  }

  option(id) {
    const label = document.createElement("label");
    const input = document.createElement("input");
    Object.assign(input, { type: "radio", name: "vehicle", value: id });
    input.addEventListener("change", () => this.onChoose(id));
    label.append(input, `Vehicle ${id}`);
    return label;
  }

  /** Adds the lines that are new. */
  say(texts) {
    // Numbers begin again when the program does.
    if (texts.length > 0 && texts[texts.length - 1].number < this.lastText) this.forget();
    for (const { number, time_s: time, vehicle, severity, text } of texts) {
      if (number <= this.lastText) continue;
      this.lastText = number;
      const line = document.createElement("li");
      line.textContent = this.choice.hidden ? `${time.toFixed(1)} s: ${text}` : `${time.toFixed(1)} s, vehicle ${vehicle}: ${text}`;
      line.classList.toggle("bad", severity <= 4);
      this.texts.prepend(line);
    }
    while (this.texts.children.length > 100) this.texts.lastChild.remove();
  }

  forget() {
    this.texts.replaceChildren();
    this.lastText = 0;
  }
}
