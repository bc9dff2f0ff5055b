// Does something that is asked for often, but not more often than is useful. What is asked for last is done, too.

export class Rarely {
  /** At most once in a period, ms. */
  constructor(period, act) {
    Object.assign(this, { period, act, done: -Infinity, timer: null });
  }

  /** Now, or when it may be done again. */
  ask() {
    if (this.timer !== null) return;
    const wait = this.done + this.period - performance.now();
    if (wait <= 0) this.run();
    else this.timer = setTimeout(() => this.run(), wait);
  }

  run() {
    this.timer = null;
    this.done = performance.now();
    this.act();
  }
}
