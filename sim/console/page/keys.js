// The keyboard, and the overlay that lists the keys.
import { element } from '/dom.js';

const descriptions = [
  [['Space'], 'play, or follow the live run; pause'],
  [['←', '→'], 'one step back, one step on'],
  [['Shift + ←', 'Shift + →'], 'ten steps back, ten steps on'],
  [['Home', 'End'], 'first step, newest step'],
  [['+', '−'], 'faster, slower'],
  [['f'], 'follow the live run'],
  [['n', 'p'], 'next event, previous event of those in the list'],
  [['?'], 'show or close this list'],
];
const mouse = [
  ['Drag in the 3-D view', 'turn; with shift or the right button: move; wheel: zoom'],
  ['Click a chart', 'select the step; drag: zoom; shift and drag: move; double click: all steps'],
];

export class Keys {
  /** `actions`: the functions that the keys call. */
  constructor(actions) {
    this.help = document.getElementById('help');
    this.fillHelp();
    this.bindings = {
      ' ': () => actions.toggle(), ArrowLeft: (ten) => actions.step(ten ? -10 : -1), ArrowRight: (ten) => actions.step(ten ? 10 : 1),
      Home: () => actions.first(), End: () => actions.last(), '+': () => actions.faster(), '=': () => actions.faster(),
      '-': () => actions.slower(), f: () => actions.follow(), n: () => actions.event(1), p: () => actions.event(-1),
      '?': () => this.toggleHelp(),
    };
    document.addEventListener('keydown', (event) => this.pressed(event));
    document.getElementById('help-button').addEventListener('click', () => this.toggleHelp());
    // A button that was clicked must not take the space key from then on.
    document.addEventListener('click', (event) => {
      const button = event.target.closest && event.target.closest('button, select, input[type=checkbox]');
      if (button && event.detail > 0 && button.tagName !== 'SELECT') button.blur();
    });
    document.addEventListener('change', (event) => {
      if (event.target.tagName === 'SELECT') event.target.blur();
    });
  }

  pressed(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || takesKey(event.target, event.key)) return;
    if (this.help.open && event.key !== '?') return;
    const action = this.bindings[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action(event.shiftKey);
  }

  toggleHelp() {
    if (this.help.open) this.help.close();
    else this.help.showModal();
  }

  fillHelp() {
    const table = element('table');
    for (const [keys, text] of descriptions) {
      const cell = element('td');
      for (const key of keys) cell.append(element('kbd', { textContent: key }), ' ');
      table.append(element('tr', {}, cell, element('td', { textContent: text })));
    }
    for (const [act, text] of mouse) table.append(element('tr', {}, element('td', { textContent: act }), element('td', { textContent: text })));
    const close = element('button', { type: 'button', textContent: 'Close', onclick: () => this.help.close() });
    this.help.append(element('h2', { textContent: 'Keys and mouse' }), table, close);
  }
}

// Fields for text take every key; buttons, check boxes and menus those that operate them.
function takesKey(target, key) {
  const tag = target.tagName;
  if (tag === 'TEXTAREA' || (tag === 'INPUT' && !['range', 'checkbox'].includes(target.type))) return true;
  if (tag === 'SELECT') return key === ' ' || key.startsWith('Arrow') || key === 'Home' || key === 'End' || /^[a-z]$/.test(key);
  return key === ' ' && (tag === 'BUTTON' || target.type === 'checkbox');
}
