// The chosen vehicle in words and numbers, and the choice among several.

const SOLVER = ["optimal", "relaxed", "iteration limit", "held"];
const LAW = ["altitude", "position", "attitude"];

/** With centimetres; nothing is minus zero. */
function metres(value) {
  return (Math.round(value * 100) / 100 + 0).toFixed(2);
}

/** Speed, and where it comes from. */
function windText([north, east, down]) {
  const speed = Math.hypot(north, east, down).toFixed(1);
  const from = Math.round(Math.atan2(-east, -north) * 180 / Math.PI + 360) % 360;
  return Number(speed) > 0 ? `${speed} m/s from ${from}°` : "none";
}

/** Rows of the table: name, text, and whether it is bad. Recordings lack some, which are left out. */
function rows(state, news) {
  const speed = Math.hypot(...state.velocity);
  const error = Math.hypot(...state.position.map((value, index) => value - state.setpoint[index]));
  const known = (value, text) => (Number.isFinite(value) ? text : null);
  const [north, east, down] = state.position;
  const situation = [
    state.lost && "simulation failed", state.crashed && "crashed", state.failsafe && "failsafe",
    state.armed ? "armed" : "disarmed", state.landed ? "on the ground" : "in the air",
  ].filter(Boolean);
  const limits = LAW.filter((_, index) => state.active[index] > 0).map((law) => `${law} ${state.active[LAW.indexOf(law)]}`);
  const worst = Math.max(...state.status);
  const iterations = state.iterations.reduce((sum, count) => sum + count, 0);
  return [
    ["Mode", news?.mode, false],
    ["State", situation.join(", "), state.lost || state.crashed || state.failsafe],
    ["Position", `N ${metres(north)}, E ${metres(east)} m`, false],
    ["Height", `${metres(-down)} m`, false],
    ["Speed", known(speed, `${speed.toFixed(2)} m/s`), false],
    ["Tracking error", state.tracks ? known(error, `${error.toFixed(3)} m`) : "no set-point", false],
    ["Thrust", known(state.thrust, `${state.thrust.toFixed(2)}${Number.isFinite(state.strongest) ? ` of ${state.strongest.toFixed(1)}` : ""} N`), false],
    ["Active limits", known(state.active[0], limits.join(", ") || "none"), false],
    ["Solver", known(worst, `${SOLVER[worst]}${Number.isFinite(iterations) ? `, ${iterations} iteration${iterations === 1 ? "" : "s"}` : ""}`), worst > 1],
    ["Battery", known(state.battery, `${(100 * state.battery).toFixed(0)} %, ${state.voltage.toFixed(1)} V`), state.battery < 0.2],
    ["Wind", known(state.wind[0], windText(state.wind)), false],
    ["Faults", news?.faults && (news.faults.join(", ") || "none"), Boolean(news?.faults?.length)],
  ].filter(([, text]) => text);
}

export class Panel {
  constructor(list, choice, texts, onChoose) {
    Object.assign(this, { list, choice, texts, onChoose });
    this.lastText = 0;
  }

  /** Shows a state. */
  draw(state, news) {
    const all = rows(state, news);
    const names = all.map(([name]) => name).join();
    if (this.names !== names) {
      this.names = names;
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

  /** Adds the lines that are new. With several vehicles they say which one they are of. */
  say(texts, several) {
    // Numbers begin again when the program does.
    if (texts.length > 0 && texts[texts.length - 1].number < this.lastText) this.forget();
    for (const { number, time_s: time, vehicle, severity, text } of texts) {
      if (number <= this.lastText) continue;
      this.lastText = number;
      const line = document.createElement("li");
      line.textContent = several ? `${time.toFixed(1)} s, vehicle ${vehicle}: ${text}` : `${time.toFixed(1)} s: ${text}`;
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
