// The latest states of a vehicle, for plots and trails.

/** What plots show of a state: name and value. */
export const SERIES = {
  north: (state) => state.position[0],
  east: (state) => state.position[1],
  up: (state) => -state.position[2],
  northTarget: (state) => (state.tracks ? state.setpoint[0] : NaN),
  eastTarget: (state) => (state.tracks ? state.setpoint[1] : NaN),
  upTarget: (state) => (state.tracks ? -state.setpoint[2] : NaN),
  northError: (state) => (state.tracks ? state.position[0] - state.setpoint[0] : NaN),
  eastError: (state) => (state.tracks ? state.position[1] - state.setpoint[1] : NaN),
  upError: (state) => (state.tracks ? state.setpoint[2] - state.position[2] : NaN),
  thrust: (state) => state.thrust,
  strongest: (state) => state.strongest,
  altitudeActive: (state) => state.active[0],
  positionActive: (state) => state.active[1],
  attitudeActive: (state) => state.active[2],
  iterations: (state) => state.iterations[0] + state.iterations[1] + state.iterations[2],
  status: (state) => Math.max(...state.status),
};
const NAMES = Object.keys(SERIES);

export class History {
  /** Keeps this many states. */
  constructor(capacity) {
    this.capacity = capacity;
    this.clear();
  }

  clear() {
    this.time = [];
    this.places = [];
    this.columns = Object.fromEntries(NAMES.map((name) => [name, []]));
  }

  /** Takes a state in. Time that runs backwards is another flight. */
  push(time, state) {
    const last = this.time[this.time.length - 1];
    if (time < last) this.clear();
    if (time === last) return;
    this.time.push(time);
    this.places.push(state.position);
    for (const name of NAMES) {
      const value = SERIES[name](state);
      this.columns[name].push(Number.isFinite(value) ? value : null);
    }
    // Cut rarely: cutting moves everything.
    if (this.time.length > 1.25 * this.capacity) this.cut(this.time.length - this.capacity);
  }

  cut(count) {
    this.time.splice(0, count);
    this.places.splice(0, count);
    for (const name of NAMES) this.columns[name].splice(0, count);
  }
}
