// Names beside what is drawn.

/** Size of a place in which one name is shown: more would cover each other, px. */
const CELL = [22, 14];

export class Labels {
  constructor(parent) {
    this.parent = parent;
  }

  /** Shows names: text, kind, how far it is lifted, px, and the point; null where it cannot be seen. The first ones go before. */
  show(named) {
    const { children } = this.parent;
    while (children.length < named.length) this.parent.append(document.createElement("span"));
    while (children.length > named.length) this.parent.lastChild.remove();
    const taken = new Set();
    named.forEach(({ text, point, lift, kind }, index) => {
      const label = children[index];
      const cell = point && point.map((value, axis) => Math.round(value / CELL[axis])).join();
      const hidden = point === null || taken.has(cell);
      if (label.hidden !== hidden) label.hidden = hidden;
      if (hidden) return;
      taken.add(cell);
      // What is written without need is laid out again without need.
      if (label.textContent !== text) label.textContent = text;
      if (label.className !== kind) label.className = kind;
      const transform = `translate(${(point[0] + 8).toFixed(1)}px, ${(point[1] - lift).toFixed(1)}px)`;
      if (label.dataset.at !== transform) {
        label.dataset.at = transform;
        label.style.transform = transform;
      }
    });
  }
}
