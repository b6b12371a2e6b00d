// The state as labelled lights. The mark's shape says as much as its colour.
import { element, setText } from '/dom.js';

// Their texts list several things, so they get a line of their own.
const wideLights = new Set(['attitude', 'pose', 'faults']);

export class Lights {
  constructor() {
    this.list = document.getElementById('lights');
    this.items = new Map();
    this.texts = {};
  }

  show(lights) {
    const names = lights.map((light) => light.name).join();
    if (names !== this.names) this.build(lights, names);
    for (const light of lights) this.showOne(light);
  }

  build(lights, names) {
    this.names = names;
    this.texts = {};
    this.items.clear();
    for (const { name } of lights) this.items.set(name, makeItem(name));
    this.list.replaceChildren(...[...this.items.values()].map((item) => item.node));
  }

  showOne({ name, text, state }) {
    const item = this.items.get(name);
    const shown = text.charAt(0).toUpperCase() + text.slice(1);
    item.label.dataset.state = state;
    setText(item.text, shown);
    item.node.title = `${name}: ${text}`;
    this.texts[name] = text;
  }
}

function makeItem(name) {
  const label = element('span', { className: 'lamp name', textContent: name.charAt(0).toUpperCase() + name.slice(1) });
  const text = element('span', { className: 'text' });
  const node = element('li', { className: wideLights.has(name) ? 'wide' : '' }, label, text);
  return { node, label, text };
}
